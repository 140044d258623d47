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
inline SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera) {
    if (!last || !lies_near(camera, last->origin_m()) || !last->can_move_to(scene)) return SceneChange::all;
    const bool same_time = last->exposure() == camera.exposure() || !scene.moves();
    return same_time && same_transforms(last->assembly(), scene) ? SceneChange::none : SceneChange::transforms;
}

}  // namespace REALCAM_NAMESPACE
