#pragma once
#include <cuda_runtime.h>

#include <new>
#include <string>

#include "cuda_error.hpp"

namespace realcam {

/// Makes a GPU the thread's current device and restores the previous one on destruction, because other libraries of the
/// process rely on it.
class CurrentDevice {
public:
    explicit CurrentDevice(int ordinal) : CurrentDevice(ordinal, std::nothrow) {
        check_cuda(code_, "choosing GPU " + std::to_string(ordinal));
    }
    /// For destructors, which may run after the GPU is lost or while the process ends, when all calls fail.
    CurrentDevice(int ordinal, std::nothrow_t) noexcept : ordinal_(ordinal), before_(ordinal) {
        cudaGetDevice(&before_);
        code_ = cudaSetDevice(ordinal_);
    }
    ~CurrentDevice() {
        if (before_ != ordinal_) cudaSetDevice(before_);
    }
    CurrentDevice(const CurrentDevice&) = delete;
    CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
    int ordinal_, before_;
    cudaError_t code_;
};

}  // namespace realcam
