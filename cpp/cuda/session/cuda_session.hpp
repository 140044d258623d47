#pragma once
#include <memory>
#include <vector>

#include "../../optics/pupil/pupil_tracer.hpp"
#include "../../render/session/session.hpp"
#include "../device/shared_device_array.hpp"

namespace realcam {

/// Makes a session on one or more GPUs of this machine, given by their CUDA ordinals; each takes a part of every
/// pixel's samples. Live frames need a single GPU. `tracer`: traces rays on the host for the pupil search. Throws
/// DeviceError if a GPU is missing or cannot run this build's code.
std::unique_ptr<Session> make_cuda_session(const std::vector<int>& ordinals, PupilTracer tracer);

/// Picture in a GPU's memory, float32 like Image: exposure (height, width, 3) and depth (height, width).
struct DevicePicture {
    SharedDeviceArray exposure, depth;
};

/// Additional interface of the sessions that make_cuda_session returns.
class DevicePictures {
public:
    virtual ~DevicePictures() = default;

    /// Returns exposure and depth of Session::picture in the memory of the first GPU. Throws as Session::picture, and
    /// DeviceError if the film does not fit into that memory.
    virtual DevicePicture device_picture(const KeepGoing& keep_going) = 0;
};

}  // namespace realcam
