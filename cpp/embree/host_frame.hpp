#pragma once
#include <atomic>
#include <cstdint>
#include <future>
#include <mutex>
#include <utility>
#include <vector>

#include "../render/session/live_frame.hpp"

namespace realcam {

/// Stop flag that the threads of the CPU backend read. Remains set until it was lowered as often as it was raised.
/// Functions may be called from any thread.
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

/// Live frame rendered by a thread of the host.
class HostFrame final : public LiveFrame {
public:
    /// Future of the 8-bit values, height x width x 3.
    using Codes = std::shared_future<std::vector<std::uint8_t>>;

    /// `samples`: see LiveFrame::samples.
    HostFrame(int width, int height, std::int64_t samples, Codes codes)
        : width_(width), height_(height), samples_(samples), codes_(std::move(codes)) {}

    int width() const override { return width_; }
    int height() const override { return height_; }
    std::int64_t samples() const override { return samples_; }
    bool wait_for(std::chrono::microseconds timeout) const override {
        return codes_.wait_for(timeout) == std::future_status::ready;
    }
    const std::uint8_t* codes() const override { return codes_.get().data(); }

private:
    int width_, height_;
    std::int64_t samples_;
    Codes codes_;
};

}  // namespace realcam
