#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "../../render/gradients/camera_gradient.hpp"

namespace realcam {

/// True if a GPU can differentiate pictures of a lens: if it has no freeform surfaces, whose dual numbers need vector
/// types that no GPU's compiler has.
inline bool gpu_differentiates(const LensSystem& lens) {
    return std::all_of(lens.surfaces.begin(), lens.surfaces.end(),
                       [](const Surface& surface) { return surface.form.adds_nothing(); });
}

/// Returns derivatives of a picture on one GPU, given by its CUDA ordinal, in reverse mode; its `forward` throws
/// InputError. Parameters: see CameraGradient. Throws InputError as CameraGradient, and for a lens
/// without gpu_differentiates; DeviceError as make_cuda_session.
std::unique_ptr<CameraGradient> make_cuda_gradient(int ordinal, const Assembly& scene, const Camera& camera,
                                                   const RenderSettings& settings, std::vector<LensVariable> variables,
                                                   const PupilTracer& tracer);

}  // namespace realcam
