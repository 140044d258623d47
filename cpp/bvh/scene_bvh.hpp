#pragma once
#include <vector>

#include "../scene/render_space/render_space_scene.hpp"
#include "build_wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// BVHs of a scene in render space: one over its static geometry, one per object, and one over the instances.
struct SceneBvh {
    WideBvh static_geometry;
    std::vector<WideBvh> objects;
    std::vector<Box> object_boxes;  ///< bounding box of each object, in its own frame
    WideNodes instances;
    double built_cost = 0;  ///< expected_nodes of `instances` when it was last built
};

/// Returns the expected number of nodes that a ray through the root's box enters (surface area heuristic).
double expected_nodes(const std::vector<WideNode>& nodes);

/// Builds all BVHs of a scene. Throws as build_wide_bvh.
SceneBvh build_scene_bvh(const RenderSpaceScene& scene, const KeepGoing& keep_going = {});

/// Updates the BVH over the instances after RenderSpaceScene::move: refits its boxes, or rebuilds it if rays would
/// enter more than twice as many nodes as when it was built.
void refit_instances(SceneBvh& bvh, const RenderSpaceScene& scene);

/// Returns the leaves of the BVH over the instances. `objects`: views of the objects' BVHs, at the addresses from which
/// traversal reads them.
std::vector<BvhInstance> bvh_instances(const SceneBvh& bvh, const RenderSpaceScene& scene,
                                       const std::vector<WideBvhView>& objects);

}  // namespace REALCAM_NAMESPACE
