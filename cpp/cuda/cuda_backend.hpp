#pragma once
#include <memory>
#include <vector>

#include "../render/backend.hpp"

namespace realcam {

/// GPUs of this host, by their CUDA ordinals: each takes its share of every pixel's samples. `tracer`: see Pupil.
/// Throws DeviceError where one is missing or cannot run this build's code.
std::unique_ptr<Backend> make_cuda_backend(const std::vector<int>& ordinals, PupilTracer tracer);

}  // namespace realcam
