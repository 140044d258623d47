#include "host_scene.hpp"

#include <utility>

namespace realcam {

void HostScene::place(const Assembly& assembly, const Camera& camera) {
    const bool moves = placed_ && lies_near(camera, placed_->origin_m()) && placed_->can_move_to(assembly);
    if (moves && same_places(placed_->assembly(), assembly)) return;
    std::unique_ptr<PlacedScene> placed = std::exchange(placed_, nullptr);
    if (moves) {
        placed->move(assembly);
        refit_instances(bvh_, *placed);
    } else {
        placed.reset();  // before the next takes as much memory
        bvh_ = {};
        placed = std::make_unique<PlacedScene>(assembly, camera.pose.position_m);
        bvh_ = build_scene_bvh(*placed);
    }
    for (DeviceRenderer* renderer : renderers_)
        moves ? renderer->set_places(*placed, bvh_) : renderer->set_scene(*placed, bvh_);
    placed_ = std::move(placed);
}

}  // namespace realcam
