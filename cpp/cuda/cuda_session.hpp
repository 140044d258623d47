#pragma once
#include <memory>
#include <vector>

#include "../optics/pupil/pupil_tracer.hpp"
#include "../render/session.hpp"
#include "shared_device_array.hpp"

namespace realcam {

/// GPUs of this host, by their CUDA ordinals: each takes its share of every pixel's samples. Frames are shot on one
/// GPU. `tracer`: see Pupil. Throws DeviceError where one is missing or cannot run this build's code.
std::unique_ptr<Session> make_cuda_session(const std::vector<int>& ordinals, PupilTracer tracer);

/// A picture in a GPU's memory. float32, as Image: exposure (height, width, 3) and depth (height, width).
struct DevicePicture {
    SharedDeviceArray exposure, depth;
};

/// What a session on one GPU offers besides.
class DevicePictures {
public:
    virtual ~DevicePictures() = default;

    /// As Session::picture, but on the GPU.
    virtual DevicePicture device_picture(const KeepGoing& keep_going) = 0;
};

}  // namespace realcam
