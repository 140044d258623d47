#pragma once
#include "../camera/camera_view.hpp"
#include "../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Kind of scene for which the kernels of a picture are compiled.
inline SceneKind kind_of(const SceneView& scene, const CameraView& camera) {
    return camera.key_count > 0 ? SceneKind::any : scene.kind;
}

/// Kind of lens for which the kernels are compiled. Methods that only serve for comparison, pixel pupils and the
/// polynomial model, are left out of the code for plain lenses.
inline LensKind lens_kind_of(const CameraView& camera) {
    if (has_any_lens(camera)) return LensKind::any;
    const bool compares = camera.pixel_pupils.known || camera.model == CameraModel::polynomial_lens;
    return compares && camera.lens.kind == LensKind::plain ? LensKind::rotational : camera.lens.kind;
}

}  // namespace REALCAM_NAMESPACE
