#pragma once
#include <vector>

#include "../scene/render_space_scene.hpp"
#include "build_wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// The BVHs of a scene in render space: one of its static geometry, one of each object, and one over the instances.
struct SceneBvh {
    WideBvh static_geometry;
    std::vector<WideBvh> objects;
    std::vector<Box> object_boxes;  ///< of each, in its own frame
    WideNodes instances;
    double built_cost = 0;  ///< expected_nodes of the latter when it was built
};

/// How many nodes a ray through the root's box enters, by the surface area heuristic.
double expected_nodes(const std::vector<WideNode>& nodes);

/// Throws what build_wide_bvh throws.
SceneBvh build_scene_bvh(const RenderSpaceScene& scene, const KeepGoing& keep_going = {});

/// After RenderSpaceScene::move: only the boxes over the objects change; or all of the hierarchy over them, where rays
/// would enter twice as many nodes of it as when it was built.
void refit_instances(SceneBvh& bvh, const RenderSpaceScene& scene);

/// The leaves over the objects, whose hierarchies are to be read from the addresses given.
std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const RenderSpaceScene& scene,
                                       const std::vector<WideBvhView>& objects);

}  // namespace REALCAM_NAMESPACE
