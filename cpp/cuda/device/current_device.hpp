#pragma once
#include <cuda_runtime.h>

#include <memory>
#include <new>
#include <string>
#include <utility>

#include "cuda_error.hpp"

namespace realcam {

/// Makes a GPU the thread's current device, and restores the previous one on destruction, because other libraries of
/// the process may rely on it.
class CurrentDevice {
public:
    /// Throws DeviceError.
    explicit CurrentDevice(int ordinal) : CurrentDevice(ordinal, std::nothrow) {
        check_cuda(code_, "choosing GPU " + std::to_string(ordinal));
    }
    /// Ignores errors. For destructors, which may run after the GPU is lost or while the process ends, when all calls
    /// fail.
    CurrentDevice(int ordinal, std::nothrow_t) noexcept : ordinal_(ordinal), previous_(ordinal) {
        cudaGetDevice(&previous_);
        code_ = cudaSetDevice(ordinal_);
    }
    ~CurrentDevice() {
        if (previous_ != ordinal_) cudaSetDevice(previous_);
    }
    CurrentDevice(const CurrentDevice&) = delete;
    CurrentDevice& operator=(const CurrentDevice&) = delete;

private:
    int ordinal_, previous_;
    cudaError_t code_;
};

/// Deleter that makes a GPU current while an object is destroyed.
struct DestroyOnDevice {
    int ordinal = 0;  ///< ordinal of the GPU

    template <class T>
    void operator()(T* object) const noexcept {
        const CurrentDevice current(ordinal, std::nothrow);
        delete object;
    }
};

/// Owner of an object that holds memory, streams or events of one GPU: the object is created and destroyed with that
/// GPU current, on any thread.
template <class T>
using OnDevice = std::unique_ptr<T, DestroyOnDevice>;

/// Constructs an object while the GPU `ordinal` is current. Throws DeviceError, and what the constructor throws.
template <class T, class... Arguments>
OnDevice<T> make_on_device(int ordinal, Arguments&&... arguments) {
    const CurrentDevice current(ordinal);
    return OnDevice<T>(new T(std::forward<Arguments>(arguments)...), {ordinal});
}

}  // namespace realcam
