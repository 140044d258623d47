#pragma once
#include "../camera/camera_view.hpp"
#include "../scene/scene_view.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

/// What the kernels for a picture have to know.
inline SceneKind kind_of(const SceneView& scene, const CameraView& camera) {
    return camera.key_count > 0 ? SceneKind::any : scene.kind;
}

/// What is there to be compared with stays out of the code for plain lenses.
inline LensKind lens_kind_of(const CameraView& camera) {
    return camera.pixel_pupils.known || camera.model == CameraModel::polynomial_lens ? LensKind::any : camera.lens.kind;
}

/// The effects for which a camera was made ready.
inline Effects effects_of(const CameraView& camera) {
    const bool disperses = camera.dispersion.to_scene != nullptr;
    const bool has_coatings = camera.coatings.one_wavelength || camera.coatings.to_scene;
    return {disperses, has_coatings, camera.diffraction.radii > 0};
}

}  // namespace REALCAM_NAMESPACE
