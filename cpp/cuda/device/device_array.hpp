#pragma once
#include <cstddef>
#include <utility>
#include <vector>

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

/// Array in the current device's memory. Grows on demand and never shrinks, so that data that changes every frame is
/// not reallocated every frame.
template <class T>
class DeviceArray {
public:
    DeviceArray() = default;
    explicit DeviceArray(std::size_t count) { resize(count); }
    ~DeviceArray() { cudaFree(data_); }
    DeviceArray(DeviceArray&& other) noexcept { *this = std::move(other); }
    DeviceArray& operator=(DeviceArray&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(capacity_, other.capacity_);
        std::swap(size_, other.size_);
        return *this;
    }

    T* data() const { return data_; }
    std::size_t size() const { return size_; }

    /// Sets the number of elements. Contents are lost if the capacity grows. Throws OutOfDeviceMemory and DeviceError.
    void resize(std::size_t count) {
        if (count > capacity_) {
            cudaFree(std::exchange(data_, nullptr));
            capacity_ = size_ = 0;
            const cudaError_t code = cudaMalloc(reinterpret_cast<void**>(&data_), count * sizeof(T));
            if (code == cudaErrorMemoryAllocation) throw_out_of_memory(count * sizeof(T));
            check_cuda(code, "allocating memory");
            capacity_ = count;
        }
        size_ = count;
    }
    // The next functions are asynchronous, in a stream of the array's device. They throw DeviceError.

    /// Resizes the array, and copies `count` elements from host memory.
    void upload(const T* from, std::size_t count, cudaStream_t stream) {
        resize(count);
        if (count == 0) return;
        check_cuda(cudaMemcpyAsync(data_, from, count * sizeof(T), cudaMemcpyHostToDevice, stream), "copying to it");
    }
    /// Copies all elements to host memory.
    void download(T* to, cudaStream_t stream) const {
        if (size_ == 0) return;
        check_cuda(cudaMemcpyAsync(to, data_, size_ * sizeof(T), cudaMemcpyDeviceToHost, stream), "copying from it");
    }
    /// Sets all bytes to 0.
    void clear(cudaStream_t stream) {
        if (size_ == 0) return;
        check_cuda(cudaMemsetAsync(data_, 0, size_ * sizeof(T), stream), "clearing memory");
    }

private:
    [[noreturn]] static void throw_out_of_memory(std::size_t requested) {
        cudaGetLastError();
        std::size_t free = 0, total = 0;
        cudaMemGetInfo(&free, &total);
        const auto mib = [](std::size_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB"; };
        throw OutOfDeviceMemory("the GPU is out of memory: " + mib(requested) + " more were requested, and " +
                                mib(free) + " of " + mib(total) + " are free");
    }

    T* data_ = nullptr;
    std::size_t capacity_ = 0, size_ = 0;
};

/// Arrays of any element type on one device, for copies of a view's arrays. Allocations are reused after restart().
class DeviceArrays {
public:
    /// Makes subsequent copies overwrite the previous ones.
    void restart() { next_ = 0; }

    /// Copies an array from the host asynchronously, and returns the copy's address on the device.
    template <class T>
    const T* copy(const T* from, std::size_t count, cudaStream_t stream) {
        if (next_ == arrays_.size()) arrays_.emplace_back();
        DeviceArray<unsigned char>& array = arrays_[next_++];
        array.upload(reinterpret_cast<const unsigned char*>(from), count * sizeof(T), stream);
        return reinterpret_cast<const T*>(array.data());
    }

private:
    std::vector<DeviceArray<unsigned char>> arrays_;
    std::size_t next_ = 0;
};

}  // namespace realcam
