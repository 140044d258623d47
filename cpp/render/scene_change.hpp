#pragma once
#include "../camera/camera.hpp"
#include "../scene/render_space_scene.hpp"

namespace REALCAM_NAMESPACE {

/// What a backend has to do for the next picture.
enum class SceneChange {
    none,
    transforms,  ///< RenderSpaceScene::move serves
    all,     ///< another scene, or a camera too far from the position of the last
};

/// `last`: null where there was none.
SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera);

}  // namespace REALCAM_NAMESPACE
