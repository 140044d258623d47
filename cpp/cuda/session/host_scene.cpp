#include "host_scene.hpp"

#include <utility>

namespace realcam {

void HostScene::place(const Assembly& assembly, const Camera& camera, const KeepGoing& keep_going) {
    const SceneChange change = change_to(assembly, camera);
    if (change == SceneChange::none) return;
    const bool moves = change == SceneChange::transforms;
    std::unique_ptr<RenderSpaceScene> placed = std::exchange(placed_, nullptr);
    if (moves) {
        placed->move(assembly, camera.exposure());
        refit_instances(bvh_, *placed);
    } else {
        placed.reset();  // freed before the next scene is allocated
        bvh_ = {};
        placed =
            std::make_unique<RenderSpaceScene>(assembly, position_when_open(camera), camera.exposure(), keep_going);
        bvh_ = build_scene_bvh(*placed, keep_going);
    }
    for (DeviceRenderer* renderer : renderers_)
        moves ? renderer->set_instances(*placed, bvh_) : renderer->set_scene(*placed, bvh_);
    placed_ = std::move(placed);
}

}  // namespace realcam
