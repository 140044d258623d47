#include "deformation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../error.hpp"
#include "assembly.hpp"
#include "scene_checks.hpp"

namespace realcam {
namespace {

constexpr Affine<double> kZero = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

/// Adds weight * map, entry by entry.
void add(Affine<double>& sum, double weight, const Affine<double>& map) {
    sum.x += weight * map.x;
    sum.y += weight * map.y;
    sum.z += weight * map.z;
    sum.origin += weight * map.origin;
}

/// Returns the transform of each joint, from rest to the frame of the skeleton's roots, at a time in seconds.
std::vector<Affine<double>> joints_at(const Deformation& deformation, double time_s) {
    std::vector<Affine<double>> nodes, joints;
    for (const SkeletonNode& node : deformation.nodes) {
        const Affine<double> map = node.motion ? node.motion->parent_from_node(time_s) : node.parent_from_node;
        nodes.push_back(node.parent < 0 ? map : nodes[static_cast<std::size_t>(node.parent)] * map);
    }
    for (std::size_t j = 0; j < deformation.joint_nodes.size(); ++j)
        joints.push_back(nodes[deformation.joint_nodes[j]] * deformation.node_from_rest[j]);
    return joints;
}

/// Returns the normal of unit length; (0, 0, 0) if it has no direction.
Vec3f unit_normal(Vec3f normal) {
    const Vec3d n = static_cast<Vec3d>(normal);
    const double size = length(n);
    return size > 0 && std::isfinite(size) ? static_cast<Vec3f>((1 / size) * n) : Vec3f{0, 0, 0};
}

/// Returns why the motion of a node is invalid; empty if it is valid.
std::string motion_keys_error(const NodeMotion& motion) {
    for (const auto& [keys, components] : {std::pair(&motion.translation_keys, 3), std::pair(&motion.rotation_keys, 4),
                                           std::pair(&motion.scale_keys, 3)})
        if (*keys)
            if (const std::string why = keys_error(**keys, static_cast<std::size_t>(components)); !why.empty())
                return why;
    return "";
}

/// Returns why the skeleton and the joints of a deformation are invalid; empty if they are valid.
std::string skeleton_error(const Deformation& deformation, std::size_t vertices) {
    for (std::size_t i = 0; i < deformation.nodes.size(); ++i) {
        const SkeletonNode& node = deformation.nodes[i];
        if (node.parent >= static_cast<std::int64_t>(i)) return "the parent of a node of its skeleton must precede it";
        if (const std::string why = node.motion ? motion_keys_error(*node.motion) : ""; !why.empty()) return why;
    }
    const std::size_t joints = deformation.joint_nodes.size();
    const bool exist = std::all_of(deformation.joint_nodes.begin(), deformation.joint_nodes.end(),
                                   [&](std::uint32_t node) { return node < deformation.nodes.size(); });
    const VertexJoints& list = deformation.vertex_joints;
    const bool are_joints =
        std::all_of(list.joints.begin(), list.joints.end(), [&](std::uint32_t joint) { return joint < joints; });
    constexpr std::uint32_t kMaxPerVertex = 64;
    if (!exist || !are_joints || deformation.node_from_rest.size() != joints || list.per_vertex > kMaxPerVertex ||
        list.joints.size() != list.per_vertex * vertices || list.weights.size() != list.joints.size())
        return "its joints must exist, and each vertex must have as many of them";
    return "";
}

/// Returns an object in its shape at a time in seconds.
std::shared_ptr<const Scene> shape_at(const Scene& object, double time_s) {
    auto shape = std::make_shared<Scene>(object);
    set_shape(*shape, time_s);
    shape->deformation = nullptr;
    for (const Vec3d& p : shape->positions_m)
        if (!in_reach(p))
            throw InputError("a deforming object at " + std::to_string(time_s) + " s: " + coordinates_error(p));
    drop_degenerate_triangles(*shape);
    return shape;
}

}  // namespace

std::string deformation_error(const Deformation& deformation, std::size_t vertices) {
    const auto is_none_or_one_each = [&](const auto& list) { return list.empty() || list.size() == vertices; };
    if (!(deformation.unit_m > 0) || !std::isfinite(deformation.unit_m)) return "its unit must be a positive length";
    if (deformation.positions.size() != vertices || !is_none_or_one_each(deformation.normals))
        return "it must have a position and a normal at rest for each vertex";
    for (const MorphTarget& target : deformation.targets)
        if (!is_none_or_one_each(target.positions) || !is_none_or_one_each(target.normals))
            return "its morph targets must have a displacement for each vertex";
    if (!deformation.target_weights)
        return deformation.targets.empty() ? skeleton_error(deformation, vertices)
                                           : "its morph targets have no weights";
    const std::string why = keys_error(*deformation.target_weights, deformation.targets.size());
    return why.empty() ? skeleton_error(deformation, vertices) : why;
}

void add_target(std::vector<Vec3d>& positions, std::vector<Vec3f>& normals, const MorphTarget& target, double weight) {
    if (weight == 0) return;
    for (std::size_t v = 0; v < target.positions.size(); ++v)
        positions[v] += weight * static_cast<Vec3d>(target.positions[v]);
    if (normals.empty()) return;
    for (std::size_t v = 0; v < target.normals.size(); ++v)
        normals[v] += static_cast<Vec3f>(weight * static_cast<Vec3d>(target.normals[v]));
}

void apply_skin(std::vector<Vec3d>& positions, std::vector<Vec3f>& normals, const VertexJoints& vertex_joints,
                const std::vector<Affine<double>>& joints, Checkpoint& checkpoint) {
    for (std::size_t v = 0; v < positions.size(); ++v) {
        checkpoint.pass();
        Affine<double> map = kZero;
        double sum = 0;
        for (std::size_t i = v * vertex_joints.per_vertex; i < (v + 1) * vertex_joints.per_vertex; ++i) {
            const auto weight = static_cast<double>(vertex_joints.weights[i]);
            if (weight == 0) continue;
            add(map, weight, joints[vertex_joints.joints[i]]);
            sum += weight;
        }
        if (sum == 0) continue;  // no joint moves it
        Affine<double> mean = kZero;
        add(mean, 1 / sum, map);
        positions[v] = mean.point(positions[v]);
        if (!normals.empty()) normals[v] = static_cast<Vec3f>(mean.normal(static_cast<Vec3d>(normals[v])));
    }
}

void set_shape(Scene& scene, double time_s) {
    const Deformation& deformation = *scene.deformation;
    std::vector<Vec3d> positions = deformation.positions;
    std::vector<Vec3f> normals = deformation.normals;
    std::vector<double> weights(deformation.targets.size());
    if (deformation.target_weights) deformation.target_weights->at(time_s, weights.data());
    for (std::size_t t = 0; t < weights.size(); ++t) add_target(positions, normals, deformation.targets[t], weights[t]);
    Checkpoint never_stops;
    if (!deformation.joint_nodes.empty())
        apply_skin(positions, normals, deformation.vertex_joints, joints_at(deformation, time_s), never_stops);
    for (Vec3d& p : positions) p = deformation.unit_m * p;
    for (Vec3f& n : normals) n = unit_normal(n);
    scene.positions_m = std::move(positions);
    scene.normals = std::move(normals);
}

Assembly with_shapes_at(Assembly assembly, double time_s, Shapes& known) {
    Shapes shapes;
    for (Instance& instance : assembly.instances) {
        if (!instance.object->deformation) continue;
        std::shared_ptr<const Scene>& shape = shapes[instance.object];
        if (const auto found = known.find(instance.object); !shape && found != known.end()) shape = found->second;
        if (!shape) shape = shape_at(*instance.object, time_s);
        instance.object = shape;
    }
    known = std::move(shapes);
    return assembly;
}

}  // namespace realcam
