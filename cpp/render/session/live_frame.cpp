#include "live_frame.hpp"

namespace realcam {

void wait(const LiveFrame& frame, const KeepGoing& keep_going) {
    while (!frame.wait_for(std::chrono::milliseconds(50)))
        if (keep_going && !keep_going()) throw Cancelled();
}

SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera) {
    if (!last || !is_near_origin(camera, last->origin_m()) || !last->can_move_to(scene)) return SceneChange::all;
    const bool same_time = last->exposure() == camera.exposure() || !scene.moves();
    return same_time && same_transforms(last->assembly(), scene) ? SceneChange::none : SceneChange::transforms;
}

}  // namespace realcam
