#pragma once
#include "../camera/camera.hpp"
#include "../scene/render_space_scene.hpp"

namespace REALCAM_NAMESPACE {

/// Work of a backend before the next picture.
enum class SceneChange {
    none,
    transforms,  ///< RenderSpaceScene::move suffices
    all,     ///< another scene, or a camera too far from the position of the last
};

/// Compares a scene with that of the last picture. `last`: null before the first.
SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera);

}  // namespace REALCAM_NAMESPACE
