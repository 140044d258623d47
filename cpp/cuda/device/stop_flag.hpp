#pragma once
#include <atomic>
#include <mutex>

#include "cuda_stream.hpp"
#include "current_device.hpp"
#include "device_array.hpp"

namespace realcam {

/// Flag that makes the kernels of one GPU end early. Their threads read it before each sample, from the GPU's memory,
/// because reading host memory takes longer than a sample. Must be created and destroyed while that GPU is the current
/// device.
class StopFlag {
public:
    explicit StopFlag(int ordinal) : ordinal_(ordinal), values_(2), flag_(1), never_(1) {
        values_.data()[0] = 0;
        values_.data()[1] = 1;
        write(false);
        never_.clear(stream_);
        stream_.wait("stopping it");
    }

    /// May be called from any thread. The flag stays set until it has been lowered as often as it was raised. Errors
    /// are ignored: a GPU that cannot be reached runs no kernel, and a thread that waits for its work gets the error.
    void raise() noexcept {
        const std::lock_guard lock(mutex_);
        if (raised_++ > 0) return;
        const CurrentDevice current(ordinal_, std::nothrow);
        try {
            write(true);
        } catch (const DeviceError&) {
        }
    }
    /// Must be called after the stopped work has ended. Throws DeviceError.
    void lower() {
        const std::lock_guard lock(mutex_);
        if (--raised_ > 0) return;
        const CurrentDevice current(ordinal_);
        write(false);
    }
    /// Returns true if the flag is set; may be called from any thread.
    bool is_raised() const { return raised_ > 0; }

    /// The flag in the GPU's memory: 1 if it is set, else 0.
    const volatile int* data() const { return flag_.data(); }
    /// A flag that is never raised.
    const volatile int* never() const { return never_.data(); }
    /// Copies the flag asynchronously to host memory. The result is not 0 if a kernel earlier in the stream has read a
    /// raised flag that has not been lowered since.
    void download(int* to, cudaStream_t stream) const { flag_.download(to, stream); }

private:
    void write(bool stop) {
        check_cuda(cudaMemcpyAsync(flag_.data(), values_.data() + stop, sizeof(int), cudaMemcpyHostToDevice, stream_),
                   "stopping it");
        stream_.wait("stopping it");
    }

    int ordinal_;
    CudaStream stream_;  // separate from the stream of the work that it stops
    PinnedArray<int> values_;  // 0 and 1, to be copied to the flag
    DeviceArray<int> flag_, never_;
    std::mutex mutex_;
    std::atomic<int> raised_{0};
};

}  // namespace realcam
