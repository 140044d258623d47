#include "gltf_nodes.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "../../error.hpp"
#include "../../math/affine.hpp"
#include "../../math/interpolate_affine.hpp"
#include "../files/regular_file.hpp"
#include "../text/help_page.hpp"
#include "../text/printable.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

namespace {

/// Greatest number of instances per node: in a file of a megabyte, a thousand nodes may share a million transforms.
constexpr std::size_t kMaxInstances = std::size_t{1} << 21;

/// Returns the transforms of a node's instances (EXT_mesh_gpu_instancing) in the node's frame; an empty list if the
/// node does not have this extension, and so has its mesh itself. `label`: names the node in messages. Throws
/// SceneFileError.
std::vector<Affine<double>> instances_of(const Json& node, GltfAccessors& accessors, const GltfDocument& document,
                                         const std::string& label) {
    const Json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    std::size_t count = 0;
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
        if (!attributes[name].is_null()) count = std::max(count, accessors.count(attributes[name]));
    if (count > kMaxInstances)
        document.fail(label + ": has " + std::to_string(count) + " instances; at most " +
                      std::to_string(kMaxInstances) + " are read");
    const auto read = [&](const char* name, const char* type, std::size_t components) {
        std::vector<float> numbers;
        if (attributes[name].is_null()) return numbers;
        const std::string where = label + ": " + name + " of its instances";
        numbers = accessors.numbers(attributes[name], type, where);
        if (numbers.size() != components * count)
            document.fail(where + ": has " + std::to_string(numbers.size() / components) + " elements for " +
                          std::to_string(count) + " instances; expected one for each");
        return numbers;
    };
    const std::vector<float> translations = read("TRANSLATION", "VEC3", 3), rotations = read("ROTATION", "VEC4", 4),
                             scales = read("SCALE", "VEC3", 3);
    const auto vector_at = [](const std::vector<float>& numbers, std::size_t first) {
        return static_cast<Vec3d>(Vec3f{numbers[first], numbers[first + 1], numbers[first + 2]});
    };
    std::vector<Affine<double>> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        NodeMotion transform;
        if (!translations.empty()) transform.translation = vector_at(translations, 3 * i);
        if (!scales.empty()) transform.scale = vector_at(scales, 3 * i);
        if (!rotations.empty()) {
            const Quaternion q = {vector_at(rotations, 4 * i), static_cast<double>(rotations[4 * i + 3])};
            if (dot(q, q) > 0) transform.rotation = q;
        }
        out.push_back(transform.parent_from_node(0));
    }
    return out;
}

/// True if the transform of a node consists of lists of numbers of the right lengths.
bool has_valid_transform(const Json& node) {
    const auto is_list = [&](const char* key, std::size_t length) {
        const Json& list = node[key];
        if (list.is_null()) return true;
        if (list.size() != length) return false;
        for (std::size_t i = 0; i < length; ++i)
            if (!list[i].is_number()) return false;
        return true;
    };
    return is_list("matrix", 16) && is_list("translation", 3) && is_list("rotation", 4) && is_list("scale", 3);
}

/// Implementation of read_gltf_nodes. Nodes of the file are identified by their indices.
class NodeReader {
public:
    NodeReader(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors, Checkpoint& checkpoint)
        : scene_(scene),
          document_(document),
          nodes_(document.root()["nodes"]),
          accessors_(accessors),
          checkpoint_(checkpoint) {}

    /// See read_gltf_nodes.
    GltfNodeIndices read(const std::string& scene_name) {
        find_parents();
        const std::vector<std::size_t> roots = find_roots(scene_name);
        for (const std::size_t root : roots) add_tree(root);
        if (bad_transforms_ > 0)
            scene_.warnings.push_back(std::to_string(bad_transforms_) +
                                      " nodes have a malformed matrix, translation, rotation or scale; it is left out");
        return std::move(file_indices_);
    }

private:
    std::string label(std::size_t node) const { return gltf_label("node", node, nodes_[node]); }

    /// Sets parents_.
    void find_parents() {
        parents_.assign(nodes_.size(), kNoGltfNode);
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            const Json& children = nodes_[n]["children"];
            for (std::size_t i = 0; i < children.size(); ++i) {
                checkpoint_.pass();
                const std::size_t child = *document_.find("nodes", not_null(children[i], n), label(n) + ": its child");
                if (parents_[child] != kNoGltfNode)
                    document_.fail(label(child) + ": is listed twice as a child; a node has at most one parent");
                parents_[child] = n;
            }
        }
    }

    /// Returns a reference, which must exist. `parent`: node that has it as a child.
    const Json& not_null(const Json& reference, std::size_t parent) const {
        if (reference.is_null()) document_.fail(label(parent) + ": its child must be a number");
        return reference;
    }

    /// Returns the index of the scene with a name, or of the scene that the name counts; std::nullopt if there is none.
    std::optional<std::size_t> scene_named(const std::string& name) const {
        const Json& scenes = document_.root()["scenes"];
        for (std::size_t i = 0; i < scenes.size(); ++i)
            if (printable(scenes[i]["name"].text()) == name) return i;
        for (std::size_t i = 0; i < scenes.size(); ++i)
            if (std::to_string(i) == name) return i;
        return std::nullopt;
    }

    /// Returns the index of the scene to read (read_gltf_nodes).
    std::size_t find_scene(const std::string& name) const {
        const Json& root = document_.root();
        const std::size_t count = root["scenes"].size();
        if (name.empty()) {
            const std::size_t scene = document_.find("scenes", root["scene"], "scene").value_or(0);
            if (count > 1)
                scene_.warnings.push_back("of " + std::to_string(count) + " scenes, " +
                                          gltf_label("scene", scene, root["scenes"][scene]) + " is read");
            return scene;
        }
        if (const std::optional<std::size_t> scene = scene_named(name)) return *scene;
        std::set<std::string> names;
        for (std::size_t i = 0; i < count; ++i) names.insert(printable(root["scenes"][i]["name"].text()));
        names.erase("");
        document_.fail("has no scene " + in_quotes(name.substr(0, 60)) +
                       did_you_mean(name, {names.begin(), names.end()}) +
                       "; expected the name or the index of one of its " + std::to_string(count) + " scenes");
    }

    /// Returns the roots of the scene to read; if the file has no scene, all nodes without a parent.
    std::vector<std::size_t> find_roots(const std::string& scene_name) const {
        const Json& root = document_.root();
        std::vector<std::size_t> roots;
        if (root["scenes"].size() == 0 && scene_name.empty()) {
            for (std::size_t n = 0; n < nodes_.size(); ++n)
                if (parents_[n] == kNoGltfNode) roots.push_back(n);
            return roots;
        }
        const std::size_t scene = find_scene(scene_name);
        const Json& listed = root["scenes"][scene]["nodes"];
        std::vector<bool> is_listed(nodes_.size(), false);
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const std::optional<std::size_t> node =
                document_.find("nodes", listed[i], "scene " + std::to_string(scene));
            if (!node) continue;
            if (parents_[*node] != kNoGltfNode || is_listed[*node])
                document_.fail(label(*node) + ": a node of a scene must be listed once, and must not have a parent");
            is_listed[*node] = true;
            roots.push_back(*node);
        }
        return roots;
    }

    /// Adds a subtree in depth-first order. Without recursion: a chain may be as long as the file. It ends, because
    /// every node has at most one parent.
    void add_tree(std::size_t root) {
        struct Open {
            std::size_t node;  // in the file
            std::size_t next_child;  // position in the list of children
            std::uint32_t index;  // in scene_.nodes
        };
        std::vector<Open> open = {{root, 0, add_node(root, kNoParent)}};
        while (!open.empty()) {
            Open& last = open.back();
            const Json& children = nodes_[last.node]["children"];
            if (last.next_child == children.size()) {
                scene_.nodes[last.index].end = static_cast<std::uint32_t>(scene_.nodes.size());
                open.pop_back();
                continue;
            }
            const std::size_t child = children[last.next_child++].index(kNoGltfNode);
            open.push_back({child, 0, add_node(child, last.index)});
        }
    }

    /// Adds a node and its instances, and returns its index in the scene. `parent`: index in the scene.
    std::uint32_t add_node(std::size_t file_index, std::uint32_t parent) {
        checkpoint_.pass();
        const Json& from = nodes_[file_index];
        if (!has_valid_transform(from)) ++bad_transforms_;
        FileNode node{printable(from["name"].text()), transform_of(from), parent};
        const Json& light = from["extensions"]["KHR_lights_punctual"]["light"];
        if (!light.is_null()) node.light = existing(light, scene_.lights.size(), file_index, "light");
        if (!from["camera"].is_null())
            node.camera = existing(from["camera"], scene_.cameras.size(), file_index, "camera");
        scene_.nodes.push_back(std::move(node));
        file_indices_.nodes.push_back(file_index);
        file_indices_.meshes.push_back(file_index);
        const auto index = static_cast<std::uint32_t>(scene_.nodes.size() - 1);
        add_instances(file_index, index);
        return index;
    }

    /// Returns the index of a node's light or camera (`kind`), which must be below `count`.
    std::int32_t existing(const Json& reference, std::size_t count, std::size_t node, const std::string& kind) const {
        const std::size_t index = reference.index(count);
        if (index >= count)
            document_.fail(label(node) + ": its " + kind + " does not exist; there are " + std::to_string(count));
        return static_cast<std::int32_t>(index);
    }

    /// Adds the instances of a node as its children. `node`: its index in the scene.
    void add_instances(std::size_t file_index, std::uint32_t node) {
        const std::vector<Affine<double>> transforms =
            instances_of(nodes_[file_index], accessors_, document_, label(file_index));
        if (transforms.empty()) return;
        constexpr std::size_t kUncheckedBytes = std::size_t{1} << 28;
        bytes_ += transforms.size() * sizeof(FileNode);
        if (const std::string why = bytes_ > kUncheckedBytes ? too_much_memory(bytes_) : ""; !why.empty())
            document_.fail("its instances need " + why);
        file_indices_.meshes[node] = kNoGltfNode;
        for (const Affine<double>& transform : transforms) {
            checkpoint_.pass();
            FileNode instance{{}, transform, node};
            instance.end = static_cast<std::uint32_t>(scene_.nodes.size() + 1);
            scene_.nodes.push_back(std::move(instance));
            file_indices_.nodes.push_back(kNoGltfNode);
            file_indices_.meshes.push_back(file_index);
        }
    }

    FileScene& scene_;
    const GltfDocument& document_;
    const Json& nodes_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::vector<std::size_t> parents_;  // of each node of the file, or kNoGltfNode
    GltfNodeIndices file_indices_;
    std::size_t bytes_ = 0;  // size of the instances' nodes
    std::size_t bad_transforms_ = 0;  // number of nodes
};

}  // namespace

GltfNodeIndices read_gltf_nodes(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                                const std::string& scene_name, Checkpoint& checkpoint) {
    return NodeReader(scene, document, accessors, checkpoint).read(scene_name);
}

std::vector<Affine<double>> global_transforms(const std::vector<FileNode>& nodes) {
    std::vector<Affine<double>> transforms;
    transforms.reserve(nodes.size());
    for (const FileNode& node : nodes)
        transforms.push_back(node.parent == kNoParent ? node.parent_from_node
                                                      : transforms[node.parent] * node.parent_from_node);
    return transforms;
}

namespace {

/// Returns a vector of JSON numbers, with default values for absent ones.
Vec3d vector_of(const Json& numbers, Vec3d defaults) {
    return {numbers[std::size_t{0}].number(defaults.x), numbers[1].number(defaults.y), numbers[2].number(defaults.z)};
}

}  // namespace

NodeMotion static_motion(const Json& node) {
    NodeMotion motion;
    const Json& q = node["rotation"];
    // The quaternion is not normalised: files round it to seven digits, and parent_from_node accepts any length.
    const Quaternion rotation = {vector_of(q, {0, 0, 0}), q[3].number(1)};
    if (dot(rotation, rotation) > 0) motion.rotation = rotation;
    motion.scale = vector_of(node["scale"], {1, 1, 1});
    motion.translation = vector_of(node["translation"], {0, 0, 0});
    return motion;
}

Affine<double> transform_of(const Json& node) {
    const Json& matrix = node["matrix"];
    if (matrix.size() == 16) return affine_of_columns([&](std::size_t i) { return matrix[i].number(0); });
    return static_motion(node).parent_from_node(0);
}

}  // namespace realcam::io
