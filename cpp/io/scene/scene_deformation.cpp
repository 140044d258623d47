#include "scene_deformation.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "scene_geometry.hpp"

namespace realcam::io {
namespace {

/// Collects the deformation of the vertices of an object from those of a file.
class DeformationReader {
public:
    DeformationReader(const FileScene& file, const FileDeformation& from, const std::vector<VertexSource>& sources,
                      Checkpoint& checkpoint)
        : file_(file), from_(from), sources_(sources), checkpoint_(checkpoint) {}

    Deformation read(double scale) {
        out_.unit_m = scale;
        const bool has_normals = std::any_of(sources_.begin(), sources_.end(), [&](const VertexSource& source) {
            return !file_.vertices[source.vertices].normals.empty();
        });
        for (const VertexSource& source : sources_) {
            checkpoint_.pass();
            const FileVertices& vertices = file_.vertices[source.vertices];
            out_.positions.push_back(vertices.positions[source.index]);
            if (has_normals)
                out_.normals.push_back(vertices.normals.empty() ? Vec3f{0, 0, 0} : vertices.normals[source.index]);
        }
        out_.target_weights = from_.target_weights;
        if (from_.target_weights) read_targets(from_.target_weights->components);
        if (!from_.joints.empty()) read_joints();
        return std::move(out_);
    }

private:
    void read_targets(std::size_t count) {
        out_.targets.resize(count);
        for (std::size_t t = 0; t < count; ++t) {
            collect(t, &MorphTarget::positions);
            collect(t, &MorphTarget::normals);
        }
    }

    /// Collects the displacements by a morph target of positions or of normals.
    void collect(std::size_t target, std::vector<Vec3f> MorphTarget::* list) {
        const auto list_of = [&](const VertexSource& source) -> const std::vector<Vec3f>* {
            const std::vector<MorphTarget>& targets = file_.vertices[source.vertices].targets;
            return target < targets.size() && !(targets[target].*list).empty() ? &(targets[target].*list) : nullptr;
        };
        if (std::none_of(sources_.begin(), sources_.end(), list_of)) return;
        for (const VertexSource& source : sources_) {
            checkpoint_.pass();
            const std::vector<Vec3f>* displacements = list_of(source);
            (out_.targets[target].*list).push_back(displacements ? (*displacements)[source.index] : Vec3f{0, 0, 0});
        }
    }

    void read_joints() {
        read_skeleton();
        VertexJoints& to = out_.vertex_joints;
        for (const VertexSource& source : sources_)
            to.per_vertex = std::max(to.per_vertex, file_.vertices[source.vertices].joints.per_vertex);
        for (const VertexSource& source : sources_) {
            checkpoint_.pass();
            const VertexJoints& from = file_.vertices[source.vertices].joints;
            for (std::uint32_t i = 0; i < to.per_vertex; ++i) {
                const std::size_t k = std::size_t{from.per_vertex} * source.index + i;
                to.joints.push_back(i < from.per_vertex ? from.joints[k] : 0);
                to.weights.push_back(i < from.per_vertex ? from.weights[k] : 0);
            }
        }
    }

    /// Sets the nodes of the skeleton: the joints and their ancestors, in the order of the file, which has ancestors
    /// first.
    void read_skeleton() {
        std::map<std::uint32_t, std::uint32_t> indices;  // in out_.nodes, by index in file_.nodes
        for (const FileJoint& joint : from_.joints)
            for (std::uint32_t i = joint.node; i != kNoParent && indices.emplace(i, 0).second;)
                i = file_.nodes[i].parent;
        for (auto& [node, index] : indices) {
            checkpoint_.pass();
            index = static_cast<std::uint32_t>(out_.nodes.size());
            const FileNode& from = file_.nodes[node];
            SkeletonNode to;
            to.parent_from_node = from.parent_from_node;
            if (from.motion >= 0)
                to.motion = std::make_shared<const NodeMotion>(file_.motions[static_cast<std::size_t>(from.motion)]);
            if (from.parent != kNoParent) to.parent = static_cast<std::int32_t>(indices[from.parent]);
            out_.nodes.push_back(std::move(to));
        }
        for (const FileJoint& joint : from_.joints) {
            out_.joint_nodes.push_back(indices[joint.node]);
            out_.node_from_rest.push_back(joint.node_from_rest);
        }
    }

    const FileScene& file_;
    const FileDeformation& from_;
    const std::vector<VertexSource>& sources_;
    Checkpoint& checkpoint_;
    Deformation out_;
};

}  // namespace

std::shared_ptr<Scene> read_deforming_object(const FileScene& file, std::uint32_t node, double scale,
                                             Checkpoint& checkpoint) {
    auto scene = std::make_shared<Scene>();
    std::vector<VertexSource> sources;
    read_geometry(
        *scene, {file, scale, node, node + 1, Affine<double>(), checkpoint},
        [](std::uint32_t, const Affine<double>&) { return LeftOut::nothing; }, &sources);
    const FileDeformation& from = file.deformations[static_cast<std::size_t>(file.nodes[node].deformation)];
    scene->deformation =
        std::make_shared<const Deformation>(DeformationReader(file, from, sources, checkpoint).read(scale));
    set_shape(*scene, 0);
    for (const Vec3d& p : scene->positions_m)
        if (!in_reach(p))
            throw SceneFileError(file.path + ": " + file.meshes[file.nodes[node].first_mesh].label +
                                 ": a deformed vertex: " + coordinates_error(p));
    return scene;
}

}  // namespace realcam::io
