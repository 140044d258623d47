#pragma once
#include "../camera/camera_view.hpp"
#include "../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// What the kernels for a picture have to know.
inline SceneKind kind_of(const SceneView& scene, const CameraView& camera) {
    return camera.key_count > 0 ? SceneKind::any : scene.kind;
}

}  // namespace REALCAM_NAMESPACE
