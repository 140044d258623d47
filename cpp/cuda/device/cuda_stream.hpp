#pragma once
#include <utility>

#include "cuda_error.hpp"

namespace realcam {

/// CUDA stream on the device that is current at construction.
class CudaStream {
public:
    CudaStream() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream"); }
    ~CudaStream() { cudaStreamDestroy(stream_); }
    CudaStream(const CudaStream&) = delete;
    CudaStream& operator=(const CudaStream&) = delete;

    operator cudaStream_t() const { return stream_; }
    void wait(const std::string& doing) const { check_cuda(cudaStreamSynchronize(stream_), doing); }

private:
    cudaStream_t stream_ = nullptr;
};

/// CUDA event: a point in a stream.
class CudaEvent {
public:
    CudaEvent() { check_cuda(cudaEventCreate(&event_), "making an event"); }
    ~CudaEvent() { cudaEventDestroy(event_); }
    CudaEvent(const CudaEvent&) = delete;
    CudaEvent& operator=(const CudaEvent&) = delete;

    void record(cudaStream_t stream) { check_cuda(cudaEventRecord(event_, stream), "starting to render"); }
    void wait() const { check_cuda(cudaEventSynchronize(event_), "rendering"); }
    bool reached() const {
        const cudaError_t code = cudaEventQuery(event_);
        if (code != cudaErrorNotReady) check_cuda(code, "rendering");
        return code == cudaSuccess;
    }
    double ms_since(const CudaEvent& earlier) const {
        float ms = 0;
        check_cuda(cudaEventElapsedTime(&ms, earlier.event_, event_), "rendering");
        return static_cast<double>(ms);
    }

private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace realcam
