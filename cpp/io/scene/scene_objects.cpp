#include "scene_objects.hpp"

#include <algorithm>

#include "../../error.hpp"
#include "../text/help_page.hpp"
#include "../text/printable.hpp"
#include "scene_deformation.hpp"
#include "scene_geometry.hpp"

namespace realcam::io {
namespace {

const LeftOutFunction kLeavesOutNothing = [](std::uint32_t, const Affine<double>&) { return LeftOut::nothing; };

/// True if a node or one of its descendants has meshes.
bool has_triangles(const FileScene& file, std::uint32_t node) {
    for (std::uint32_t i = node; i < file.nodes[node].end; ++i)
        if (file.nodes[i].mesh_count > 0) return true;
    return false;
}

/// Moves the warnings about an object to the static geometry.
void move_warnings(Scene& object, Scene& static_geometry) {
    static_geometry.warnings.insert(static_geometry.warnings.end(), object.warnings.begin(), object.warnings.end());
    object.warnings.clear();
}

}  // namespace

SceneObjects::SceneObjects(const FileScene& file, double scale, const std::vector<std::string>& names,
                           Checkpoint& checkpoint)
    : file_(file), scale_(scale), checkpoint_(checkpoint), names_(names.begin(), names.end()) {
    std::map<Meshes, std::size_t> use_counts;
    std::set<std::string> node_names;
    for (std::uint32_t i = 0; i < file.nodes.size(); ++i) {
        checkpoint.pass();
        if (!names.empty()) node_names.insert(file.nodes[i].name);
        if (file.nodes[i].mesh_count > 0) ++use_counts[meshes_of(i)];
    }
    for (const std::string& name : names)
        if (!node_names.contains(name))
            throw SceneFileError(file.path + ": has no node " + in_quotes(name) +
                                 did_you_mean(name, {node_names.begin(), node_names.end()}));
    shows_.assign(file.nodes.size(), false);
    for (auto i = static_cast<std::uint32_t>(file.nodes.size()); i-- > 0;) {
        const FileNode& node = file.nodes[i];
        if (node.mesh_count > 0 || node.light >= 0) shows_[i] = true;
        if (shows_[i] && node.parent != kNoParent) shows_[node.parent] = true;
    }
    for (const auto& [meshes, count] : use_counts)
        if ((count - 1) * triangle_count(meshes) >= kMinSavedTriangles) shared_.insert(meshes);
}

std::size_t SceneObjects::triangle_count(const Meshes& meshes) const {
    std::size_t count = 0;
    for (std::uint32_t m = meshes.first; m < meshes.first + meshes.second; ++m)
        count += file_.meshes[m].triangles.size();
    return count;
}

LeftOut SceneObjects::left_out(std::uint32_t node, const Affine<double>& transform) const {
    if (names_.contains(file_.nodes[node].name) || moves(node)) return LeftOut::all;
    // A node scaled to zero, by which animations hide nodes, yields no triangles in the static geometry, and no valid
    // transform for an instance.
    if (deforms(node)) return LeftOut::meshes;
    const bool is_shared =
        file_.nodes[node].mesh_count > 0 && shared_.contains(meshes_of(node)) && transform_error(transform).empty();
    return is_shared ? LeftOut::meshes : LeftOut::nothing;
}

void SceneObjects::add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry) {
    if (left_out(node, transform) == LeftOut::all)
        return add_node(node, transform, Instance::kNoParentInstance, static_geometry);
    if (deforms(node)) return add_deforming(node, transform, Instance::kNoParentInstance, static_geometry);
    std::shared_ptr<Scene>& shared = shared_scenes_[meshes_of(node)];
    if (!shared) shared = read_meshes(node);
    add_scene(shared, node, transform, Instance::kNoParentInstance, static_geometry);
}

void SceneObjects::add_node(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of,
                            Scene& static_geometry) {
    const std::ptrdiff_t next_instance = std::ssize(instances_);
    const bool is_named = names_.contains(file_.nodes[node].name);
    // Descendants that become instances of their own.
    const LeftOutFunction parts = [&](std::uint32_t index, const Affine<double>&) {
        const bool is_part = moves(index) || (!is_named && names_.contains(file_.nodes[index].name));
        return index != node && is_part ? LeftOut::all : deforms(index) ? LeftOut::meshes : LeftOut::nothing;
    };
    const auto scene = read_object(node, transform, parts, static_geometry);
    if (!scene->triangles.empty() || !scene->points.empty())
        add_scene(scene, node, transform, part_of, static_geometry);
    else
        move_warnings(*scene, static_geometry);
    const std::ptrdiff_t parent = std::ssize(instances_) > next_instance ? next_instance : part_of;
    visit_nodes({file_, scale_, node, file_.nodes[node].end, transform, checkpoint_},
                [&](std::uint32_t part, const Affine<double>& part_transform) {
                    if (parts(part, part_transform) == LeftOut::all) {
                        add_node(part, part_transform, parent, static_geometry);
                        return false;
                    }
                    if (deforms(part)) add_deforming(part, part_transform, parent, static_geometry);
                    return true;
                });
}

void SceneObjects::add_deforming(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of,
                                 Scene& static_geometry) {
    const std::shared_ptr<Scene> scene = read_deforming_object(file_, node, scale_, checkpoint_);
    const FileDeformation& deformation = file_.deformations[static_cast<std::size_t>(file_.nodes[node].deformation)];
    if (deformation.joints.empty()) return add_scene(scene, node, transform, part_of, static_geometry);
    // The transform of the node does not count for a skin, whose joints place the vertices in the scene.
    instances_.push_back({scene, Instance{nullptr, Affine<double>(), file_.nodes[node].name, part_of}});
    move_warnings(*scene, static_geometry);
}

void SceneObjects::add_scene(const std::shared_ptr<Scene>& scene, std::uint32_t node, const Affine<double>& transform,
                             std::ptrdiff_t part_of, Scene& static_geometry) {
    move_warnings(*scene, static_geometry);
    const AnimatedTransform animated = placement(node, transform, static_geometry);
    if (animated.motion == nullptr && (file_.nodes[node].motion >= 0 || deforms(node)) &&
        !transform_error(animated.scene_from_object).empty()) {
        static_geometry.warnings.push_back(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                                           " is scaled to zero while it moves or changes its shape, and is left out");
        return;
    }
    Instance instance{nullptr, animated.scene_from_object, file_.nodes[node].name, part_of};
    instance.motion = animated.motion;
    instances_.push_back({scene, instance});
}

Affine<double> SceneObjects::transform_at(std::uint32_t node, double time) {
    // Limit on the time of reading: for a chain of n moving nodes, each key of each node requires n matrix products.
    constexpr double kMaxProducts = 3e8;
    Affine<double> map;
    for (std::uint32_t i = node; i != kNoParent; i = file_.nodes[i].parent) {
        const FileNode& ancestor = file_.nodes[i];
        map = (ancestor.motion >= 0 ? file_.motions[static_cast<std::size_t>(ancestor.motion)].parent_from_node(time)
                                    : ancestor.parent_from_node) *
              map;
        checkpoint_.pass();
        if (++products_ > kMaxProducts)
            throw SceneFileError(file_.path + ": its animation has too many keys on nodes that move with each other");
    }
    map.origin = scale_ * map.origin;
    return map;
}

AnimatedTransform SceneObjects::placement(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry) {
    std::vector<double> times;
    for (std::uint32_t i = node; i != kNoParent; i = file_.nodes[i].parent) {
        if (file_.nodes[i].motion < 0) continue;
        const std::vector<double> node_times = file_.motions[static_cast<std::size_t>(file_.nodes[i].motion)].times();
        times.insert(times.end(), node_times.begin(), node_times.end());
    }
    if (times.empty()) {
        Affine<double> scaled = transform;
        scaled.origin = scale_ * scaled.origin;
        return scaled;
    }
    times = sorted_unique(std::move(times));
    Motion keys;
    for (const double time : times) {
        keys.times_s.push_back(time);
        keys.transforms.push_back(transform_at(node, time));
    }
    if (!motion_error(keys).empty()) {
        const Affine<double> first = transform_at(node, 0);
        if (transform_error(first).empty())
            static_geometry.warnings.push_back(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                                               " is scaled to zero while it moves, and stays as it is at time 0");
        return first;
    }
    return sampled_motion(times, [&](double time) { return transform_at(node, time); });
}

std::shared_ptr<Scene> SceneObjects::read_object(std::uint32_t node, const Affine<double>& transform,
                                                 const LeftOutFunction& leaves_out, Scene& static_geometry) const {
    auto scene = std::make_shared<Scene>();
    const std::uint32_t end = file_.nodes[node].end;
    const ScenePart part{file_, scale_, node, end, Affine<double>(), checkpoint_};
    read_lights(*scene, part, leaves_out);
    if (has_triangles(file_, node))
        read_geometry(*scene, part, leaves_out);
    else if (scene->points.empty() && names_.contains(file_.nodes[node].name))
        throw SceneFileError(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                             " holds neither triangles nor a light that has a position");
    // A directional light has no position: it illuminates the whole scene, in its direction in the scene.
    Scene in_scene_frame;
    read_lights(in_scene_frame, {file_, scale_, node, end, transform, checkpoint_}, leaves_out);
    static_geometry.suns.insert(static_geometry.suns.end(), in_scene_frame.suns.begin(), in_scene_frame.suns.end());
    scene->suns.clear();
    return scene;
}

std::shared_ptr<Scene> SceneObjects::read_meshes(std::uint32_t node) const {
    auto scene = std::make_shared<Scene>();
    // The part is this node only, because its descendants are handled on their own.
    read_geometry(*scene, {file_, scale_, node, node + 1, Affine<double>(), checkpoint_}, kLeavesOutNothing);
    return scene;
}

std::vector<Instance> SceneObjects::finish(const Scene& materials) {
    std::set<Scene*> has_materials;
    std::vector<Instance> instances;
    for (auto& [scene, instance] : instances_) {
        checkpoint_.pass();
        if (has_materials.insert(scene.get()).second) keep_used_materials(*scene, materials);
        instance.object = scene;
        instances.push_back(instance);
    }
    return instances;
}

/// Removes the textures for which the scene's vertices have no texture coordinates.
void drop_textures_without_uvs(Material& material, const Scene& scene) {
    for (const auto member : kMaterialTextures) {
        TextureReference& texture = material.*member;
        if ((texture.uv_set == 0 ? scene.uvs : scene.second_uvs).empty()) texture = {};
    }
}

void keep_all_materials(Scene& scene, Scene from) {
    scene.materials = std::move(from.materials);
    scene.material_names = std::move(from.material_names);
    scene.textures = std::move(from.textures);
    for (Material& material : scene.materials) drop_textures_without_uvs(material, scene);
}

void keep_used_materials(Scene& scene, const Scene& from) {
    std::map<std::uint32_t, std::uint32_t> materials;  // from old to new indices
    std::map<std::int32_t, std::int32_t> textures;  // from old to new indices
    std::vector<Material> used;
    scene.material_names.clear();
    for (Triangle& triangle : scene.triangles) {
        const auto [material, is_new] =
            materials.try_emplace(triangle.material, static_cast<std::uint32_t>(used.size()));
        if (is_new) {
            used.push_back(from.materials[triangle.material]);
            if (!from.material_names.empty()) scene.material_names.push_back(from.material_names[triangle.material]);
        }
        triangle.material = material->second;
    }
    for (Material& material : used) {
        drop_textures_without_uvs(material, scene);
        for (const auto member : kMaterialTextures) {
            std::int32_t& texture_index = (material.*member).texture;
            if (texture_index < 0) continue;
            const auto [texture, is_new] =
                textures.try_emplace(texture_index, static_cast<std::int32_t>(scene.textures.size()));
            if (is_new) scene.textures.push_back(from.textures[static_cast<std::size_t>(texture_index)]);
            texture_index = texture->second;
        }
    }
    scene.materials = std::move(used);
}

}  // namespace realcam::io
