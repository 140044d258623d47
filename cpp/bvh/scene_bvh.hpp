#pragma once
#include <vector>

#include "../scene/placed_scene.hpp"
#include "build_wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// The hierarchies of a placed scene: one of the ground, one of each object, and one over the objects where they stand.
struct SceneBvh {
    WideBvh ground;
    std::vector<WideBvh> objects;
    std::vector<Box> object_boxes;  ///< of each, in its own frame
    WideNodes instances;
};

/// Throws what build_wide_bvh throws.
SceneBvh build_scene_bvh(const PlacedScene& scene);

/// After PlacedScene::move: only the boxes over the objects change.
void refit_instances(SceneBvh& bvh, const PlacedScene& scene);

/// The leaves over the objects, whose hierarchies are to be read at the places given.
std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const PlacedScene& scene,
                                       const std::vector<WideBvhView>& objects);

}  // namespace REALCAM_NAMESPACE
