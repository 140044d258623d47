#pragma once
#include "traverse_wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

/// Traversal stack: up to two entries per level of the BVH over the instances, and one per level of an object's BVH.
using SceneTraversalStack = PendingSlots[3 * kMaxBvhDepth];

/// Two-level traversal of a ray: first through the BVH of the static geometry, then through the BVH over the instances
/// (the TLAS of other renderers), and from there through the BVH of each instance's mesh (a BLAS), in the mesh's own
/// frame. Nodes of all three are entered at one point of the code, so that lanes of a GPU's warp that are in different
/// BVHs step together.
///
/// Traversal is watertight within a mesh. Two meshes share no edges, because their vertices come from different
/// roundings.
class SceneTraversal : Traversal {
public:
    REALCAM_INLINE SceneTraversal(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far, bool any)
        : Traversal(origin, direction, far, any),
          origin_(origin),
          direction_(direction),
          nodes_(bvh.static_geometry.nodes),
          triangles_of_mesh_(bvh.static_geometry.triangles) {}

    using Traversal::active;
    using Traversal::hit;

    /// Enters one node of the current BVH and tests triangles, as Traversal::step does; then proceeds to the next
    /// pending node, instance or BVH. `scene_ray`: PlainSceneRay or AnySceneRay (opacity.hpp). The ray must be active.
    template <class SceneRay>
    REALCAM_INLINE void step(const SceneBvhView& bvh, SceneTraversalStack& stack, const SceneRay& scene_ray) {
        // enter_node<true>, the variant with less code, is 9% faster here, and 2 to 4% slower in a traversal without
        // instances (H100).
        if (!triangles_) enter_node<true>(nodes_, stack);
        if (current_ == CurrentBvh::instances) {
            push_instances(stack);
        } else if (intersect_triangles(triangles_of_mesh_, instance_, scene_ray) && any_) {
            pending_.slots = triangles_ = 0;
            return;
        }
        while (!active() && advance(bvh, stack, scene_ray)) {
        }
    }

private:
    /// BVH that is being traversed. In that over the instances, leaves hold instances, and the members of Traversal
    /// that are named after triangles (triangles_, first_triangle_) refer to instances.
    enum class CurrentBvh { static_geometry, instances, instanced_mesh };

    /// Flag in PendingSlots::slots of a stack entry that holds instances: its `first_child` is then the first instance
    /// of a node, and bit k of its slots stands for the k-th instance from there.
    static constexpr std::uint32_t kInstances = 0x80000000u;

    /// Pushes the instances whose boxes the ray intersects in the last node, to be entered after its child nodes.
    REALCAM_INLINE void push_instances(SceneTraversalStack& stack) {
        if (!triangles_) return;
        std::uint32_t instances = kInstances;
        while (triangles_) {
            const unsigned lowest = lowest_bit(triangles_);
            triangles_ ^= lowest;
            instances |= 1u << count_bits(content_ & (lowest - 1u));
        }
        stack[stack_size_++] = {first_triangle_, instances};
    }

    /// Pops the next entry from the stack, or proceeds to the next BVH, after the current node is done. Returns false
    /// if the traversal is complete.
    template <class SceneRay>
    REALCAM_INLINE bool advance(const SceneBvhView& bvh, SceneTraversalStack& stack, const SceneRay& scene_ray) {
        if (current_ == CurrentBvh::instanced_mesh && stack_size_ == stack_base_) {
            current_ = CurrentBvh::instances;
            nodes_ = bvh.nodes;
            stack_base_ = 0;
        }
        if (stack_size_ == stack_base_) {
            if (current_ == CurrentBvh::instances) return false;
            current_ = CurrentBvh::instances;  // the static geometry is done
            nodes_ = bvh.nodes;
            pending_ = pending_root();
            return true;
        }
        PendingSlots& next = stack[stack_size_ - 1];
        if (next.slots & kInstances) {
            const unsigned lowest = lowest_bit(next.slots);
            next.slots ^= lowest;
            if (next.slots == kInstances) --stack_size_;
            enter_instance(load_constant(bvh.instances + next.first_child + count_bits(lowest - 1u)), scene_ray);
            return true;
        }
        if (current_ == CurrentBvh::instances && is_transformed_) {
            transform_ray(origin_, direction_);
            is_transformed_ = false;
        }
        pending_ = next;
        --stack_size_;
        return true;
    }

    /// Transforms the ray into the frame of an instance's mesh, and starts the traversal of that mesh's BVH at its
    /// root.
    template <class SceneRay>
    REALCAM_INLINE void enter_instance(const BvhInstance& instance, const SceneRay& scene_ray) {
        current_ = CurrentBvh::instanced_mesh;
        instance_ = instance.index;
        nodes_ = instance.object.nodes;
        triangles_of_mesh_ = instance.object.triangles;
        stack_base_ = stack_size_;
        is_transformed_ = true;
        InverseAffine<float> into = instance.object_from_render;
        if constexpr (!SceneRay::is_plain) {
            if (instance.moves) into = scene_ray.into_object(instance.index);
        }
        transform_ray(into.point(origin_), into.direction(direction_));
    }

    Vec3f origin_, direction_;  ///< ray in render space
    const WideNode* nodes_;  ///< nodes of the BVH being traversed
    const BvhTriangle* triangles_of_mesh_;  ///< triangles of the static geometry or of the current instance's mesh
    std::uint32_t instance_ = kNoInstance;  ///< index of the current instance, stored in hits
    CurrentBvh current_ = CurrentBvh::static_geometry;
    int stack_base_ = 0;  ///< stack entries below this index do not belong to the current instance's mesh
    bool is_transformed_ = false;  ///< true if the ray is in the frame of an instance's mesh
};

/// Traces a ray to the end; `any`: ends at the first hit found. Returns Traversal::hit.
template <class SceneRay>
REALCAM_ONE_COPY Hit traverse(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far, bool any,
                              SceneRay scene_ray) {
    SceneTraversal ray(bvh, origin, direction, far, any);
    SceneTraversalStack stack;
    while (ray.active()) ray.step(bvh, stack, scene_ray);
    return ray.hit(far);
}

/// Returns the closest hit in a scene; see closest_hit of WideBvhView. `instanced`: true if the scene has instances;
/// with false, only the static geometry is traversed. The ray is given in render space.
template <bool instanced, class SceneRay = PlainSceneRay>
REALCAM_HD inline Hit closest_hit(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                                  const SceneRay& scene_ray = {}) {
    if constexpr (instanced)
        return traverse(bvh, origin, direction, far, false, scene_ray);
    else
        return closest_hit(bvh.static_geometry, origin, direction, far, scene_ray);
}

/// True if the scene has a hit at a distance in [0, far), in units of the direction's length; `instanced` as for
/// closest_hit.
template <bool instanced, class SceneRay = PlainSceneRay>
REALCAM_HD inline bool any_hit(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far,
                               const SceneRay& scene_ray = {}) {
    if constexpr (instanced)
        return traverse(bvh, origin, direction, far, true, scene_ray).triangle != kNoTriangle;
    else
        return any_hit(bvh.static_geometry, origin, direction, far, scene_ray);
}

}  // namespace REALCAM_NAMESPACE
