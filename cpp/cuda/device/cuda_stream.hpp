#pragma once
#include <utility>

#include "cuda_error.hpp"

namespace realcam {

/// CUDA stream on the device that is current at construction.
class CudaStream {
public:
    CudaStream() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "creating a stream"); }
    ~CudaStream() { cudaStreamDestroy(stream_); }
    CudaStream(const CudaStream&) = delete;
    CudaStream& operator=(const CudaStream&) = delete;

    operator cudaStream_t() const { return stream_; }
    /// Waits for all work in the stream. `doing`: see check_cuda. Throws DeviceError.
    void wait(const std::string& doing) const { check_cuda(cudaStreamSynchronize(stream_), doing); }

private:
    cudaStream_t stream_ = nullptr;
};

/// CUDA event: marks a point in a stream. Functions throw DeviceError.
class CudaEvent {
public:
    CudaEvent() { check_cuda(cudaEventCreate(&event_), "creating an event"); }
    ~CudaEvent() { cudaEventDestroy(event_); }
    CudaEvent(const CudaEvent&) = delete;
    CudaEvent& operator=(const CudaEvent&) = delete;

    /// Marks the end of the work that the stream contains now.
    void record(cudaStream_t stream) { check_cuda(cudaEventRecord(event_, stream), "starting to render"); }
    /// Waits for that work.
    void wait() const { check_cuda(cudaEventSynchronize(event_), "rendering"); }
    /// Returns true if that work is complete.
    bool reached() const {
        const cudaError_t code = cudaEventQuery(event_);
        if (code != cudaErrorNotReady) check_cuda(code, "rendering");
        return code == cudaSuccess;
    }
    /// Returns the milliseconds between two events, which both must be complete.
    double ms_since(const CudaEvent& earlier) const {
        float ms = 0;
        check_cuda(cudaEventElapsedTime(&ms, earlier.event_, event_), "rendering");
        return static_cast<double>(ms);
    }

private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace realcam
