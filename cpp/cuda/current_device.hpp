#pragma once
#include <cuda_runtime.h>

#include "cuda_error.hpp"

namespace realcam {

/// Makes a GPU the thread's current one, and afterwards the one that was: other libraries of the process go by it.
class CurrentDevice {
public:
    explicit CurrentDevice(int ordinal) : ordinal_(ordinal), before_(ordinal) {
        cudaGetDevice(&before_);
        check_cuda(cudaSetDevice(ordinal), "choosing GPU " + std::to_string(ordinal));
    }
    ~CurrentDevice() {
        if (before_ != ordinal_) cudaSetDevice(before_);
    }
    CurrentDevice(const CurrentDevice&) = delete;
    CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
    int ordinal_, before_;
};

}  // namespace realcam
