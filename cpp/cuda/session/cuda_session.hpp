#pragma once
#include <memory>
#include <vector>

#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../render/session/session.hpp"
#include "../device/shared_device_array.hpp"

namespace realcam {

/// Session on one or more GPUs of this host, given by CUDA ordinals: each takes a share of every pixel's samples. Live
/// frames need a single GPU. `tracer`: see Pupil. Throws DeviceError if a GPU is missing or cannot run this build's
/// code.
std::unique_ptr<Session> make_cuda_session(const std::vector<int>& ordinals, PupilTracer tracer);

/// Picture in a GPU's memory, float32 like Image: exposure (height, width, 3) and depth (height, width).
struct DevicePicture {
    SharedDeviceArray exposure, depth;
};

/// Additional interface of CUDA sessions.
class DevicePictures {
public:
    virtual ~DevicePictures() = default;

    /// Like Session::picture, with the result in the GPU's memory.
    virtual DevicePicture device_picture(const KeepGoing& keep_going) = 0;
};

}  // namespace realcam
