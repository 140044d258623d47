#pragma once
#include <cstddef>

#include "cuda_error.hpp"

namespace realcam {

/// Pinned host memory, which the GPU reads and writes asynchronously at full speed.
template <class T>
class PinnedArray {
public:
    explicit PinnedArray(std::size_t count) : size_(count) {
        check_cuda(cudaHostAlloc(reinterpret_cast<void**>(&data_), count * sizeof(T), cudaHostAllocMapped),
                   "allocating memory of the host");
    }
    ~PinnedArray() { cudaFreeHost(data_); }
    PinnedArray(const PinnedArray&) = delete;
    PinnedArray& operator=(const PinnedArray&) = delete;

    T* data() const { return data_; }
    std::size_t size() const { return size_; }

private:
    T* data_ = nullptr;
    std::size_t size_;
};

}  // namespace realcam
