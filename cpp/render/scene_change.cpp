#include "scene_change.hpp"

namespace realcam {

SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera) {
    if (!last || !lies_near(camera, last->origin_m()) || !last->can_move_to(scene)) return SceneChange::all;
    const bool same_time = last->exposure() == camera.exposure() || !scene.moves();
    return same_time && same_transforms(last->assembly(), scene) ? SceneChange::none : SceneChange::transforms;
}

}  // namespace realcam
