#pragma once
#include <atomic>
#include <mutex>

namespace realcam {

/// Stop flag for the host's threads. Remains set until it was lowered as often as it was raised.
class HostStop {
public:
    void raise() {
        const std::lock_guard lock(mutex_);
        ++raised_;
        flag_ = true;
    }
    void lower() {
        const std::lock_guard lock(mutex_);
        flag_ = --raised_ > 0;
    }
    const std::atomic<bool>& flag() const { return flag_; }

private:
    std::mutex mutex_;
    int raised_ = 0;
    std::atomic<bool> flag_{false};
};

}  // namespace realcam
