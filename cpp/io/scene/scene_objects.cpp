#include "scene_objects.hpp"

#include <algorithm>

#include "../../error.hpp"
#include "../text/help_page.hpp"
#include "../text/printable.hpp"
#include "scene_geometry.hpp"

namespace realcam::io {
namespace {

const LeavesOut kLeavesOutNothing = [](std::uint32_t, const Affine<double>&) { return LeftOut::nothing; };

bool has_triangles(const FileScene& file, std::uint32_t node) {
    for (std::uint32_t i = node; i < file.nodes[node].end; ++i)
        if (file.nodes[i].mesh_count > 0) return true;
    return false;
}

}  // namespace

SceneObjects::SceneObjects(const FileScene& file, double scale, const std::vector<std::string>& names,
                           Checkpoint& checkpoint)
    : file_(file), scale_(scale), checkpoint_(checkpoint), names_(names.begin(), names.end()) {
    std::map<Meshes, std::size_t> uses;
    std::set<std::string> found;
    for (std::uint32_t i = 0; i < file.nodes.size(); ++i) {
        checkpoint.pass();
        if (!names.empty()) found.insert(file.nodes[i].name);
        if (file.nodes[i].mesh_count > 0) ++uses[meshes_of(i)];
    }
    for (const std::string& name : names)
        if (!found.contains(name))
            throw SceneFileError(file.path + ": has no node " + in_quotes(name) +
                                 did_you_mean(name, {found.begin(), found.end()}));
    shows_.assign(file.nodes.size(), false);
    for (auto i = static_cast<std::uint32_t>(file.nodes.size()); i-- > 0;) {
        const FileNode& node = file.nodes[i];
        if (node.mesh_count > 0 || node.light >= 0) shows_[i] = true;
        if (shows_[i] && node.parent != kNoParent) shows_[node.parent] = true;
    }
    for (const auto& [meshes, times] : uses)
        if ((times - 1) * triangle_count(meshes) >= kSharedTriangles) shared_.insert(meshes);
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
    const bool is_shared =
        file_.nodes[node].mesh_count > 0 && shared_.contains(meshes_of(node)) && transform_error(transform).empty();
    return is_shared ? LeftOut::meshes : LeftOut::nothing;
}

void SceneObjects::add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry) {
    if (left_out(node, transform) == LeftOut::all)
        return add_node(node, transform, Instance::kNoWhole, static_geometry);
    std::shared_ptr<Scene>& shared = shared_scenes_[meshes_of(node)];
    if (!shared) shared = read_meshes(node);
    add_scene(shared, node, transform, Instance::kNoWhole, static_geometry);
}

void SceneObjects::add_node(std::uint32_t node, const Affine<double>& transform, std::ptrdiff_t part_of,
                            Scene& static_geometry) {
    const std::ptrdiff_t before = std::ssize(instances_);
    const bool is_named = names_.contains(file_.nodes[node].name);
    const LeavesOut objects_below = [&](std::uint32_t number, const Affine<double>&) {
        const bool is_own = moves(number) || (!is_named && names_.contains(file_.nodes[number].name));
        return number != node && is_own ? LeftOut::all : LeftOut::nothing;
    };
    const auto scene = read_object(node, transform, objects_below, static_geometry);
    if (!scene->triangles.empty() || !scene->points.empty())
        add_scene(scene, node, transform, part_of, static_geometry);
    const std::ptrdiff_t whole = std::ssize(instances_) > before ? before : part_of;
    visit_nodes({file_, scale_, node, file_.nodes[node].end, transform, checkpoint_},
                [&](std::uint32_t number, const Affine<double>& below) {
                    if (objects_below(number, below) == LeftOut::nothing) return true;
                    add_node(number, below, whole, static_geometry);
                    return false;
                });
}

void SceneObjects::add_scene(const std::shared_ptr<Scene>& scene, std::uint32_t node, const Affine<double>& transform,
                             std::ptrdiff_t part_of, Scene& static_geometry) {
    static_geometry.warnings.insert(static_geometry.warnings.end(), scene->warnings.begin(), scene->warnings.end());
    scene->warnings.clear();
    const AnimatedTransform moved = placement(node, transform);
    if (moved.motion == nullptr && file_.nodes[node].motion >= 0 && !transform_error(moved.scene_from_object).empty()) {
        static_geometry.warnings.push_back(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                                           " is scaled to nothing while it moves, and left out");
        return;
    }
    Instance instance{nullptr, moved.scene_from_object, file_.nodes[node].name, part_of};
    instance.motion = moved.motion;
    instances_.push_back({scene, instance});
}

Affine<double> SceneObjects::transform_at(std::uint32_t node, double time) {
    // Limit on matrix products: a chain of moving nodes costs its length for each key of each node.
    constexpr double kMost = 3e8;
    Affine<double> map;
    for (std::uint32_t i = node; i != kNoParent; i = file_.nodes[i].parent) {
        const FileNode& at = file_.nodes[i];
        map = (at.motion >= 0 ? file_.motions[static_cast<std::size_t>(at.motion)].parent_from_node(time)
                              : at.parent_from_node) *
              map;
        checkpoint_.pass();
        if (++matrices_ > kMost)
            throw SceneFileError(file_.path + ": its animation has too many keys on nodes that move with each other");
    }
    map.origin = scale_ * map.origin;
    return map;
}

AnimatedTransform SceneObjects::placement(std::uint32_t node, const Affine<double>& transform) {
    std::vector<double> times;
    for (std::uint32_t i = node; i != kNoParent; i = file_.nodes[i].parent) {
        if (file_.nodes[i].motion < 0) continue;
        const std::vector<double> more = file_.motions[static_cast<std::size_t>(file_.nodes[i].motion)].times();
        times.insert(times.end(), more.begin(), more.end());
    }
    if (times.empty()) {
        Affine<double> scaled = transform;
        scaled.origin = scale_ * scaled.origin;
        return scaled;
    }
    times = sorted_once(std::move(times));
    Motion keys;
    for (const double time : times) {
        keys.times_s.push_back(time);
        keys.transforms.push_back(transform_at(node, time));
    }
    // If a key scales the node to zero, it is static at its transform at time 0, or left out.
    if (!motion_error(keys).empty()) return transform_at(node, 0);
    return sampled_motion(times, [&](double time) { return transform_at(node, time); });
}

std::shared_ptr<Scene> SceneObjects::read_object(std::uint32_t node, const Affine<double>& transform,
                                                 const LeavesOut& leaves_out, Scene& static_geometry) const {
    auto scene = std::make_shared<Scene>();
    const std::uint32_t end = file_.nodes[node].end;
    const ScenePart part{file_, scale_, node, end, Affine<double>(), checkpoint_};
    read_lights(*scene, part, leaves_out);
    if (has_triangles(file_, node))
        read_geometry(*scene, part, leaves_out);
    else if (scene->points.empty() && names_.contains(file_.nodes[node].name))
        throw SceneFileError(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                             " holds neither triangles nor a light");
    // A directional light has no position: it lights the whole scene, in its current direction.
    Scene in_place;
    read_lights(in_place, {file_, scale_, node, end, transform, checkpoint_}, leaves_out);
    static_geometry.suns.insert(static_geometry.suns.end(), in_place.suns.begin(), in_place.suns.end());
    scene->suns.clear();
    return scene;
}

std::shared_ptr<Scene> SceneObjects::read_meshes(std::uint32_t node) const {
    auto scene = std::make_shared<Scene>();
    // Without the nodes below, which are handled on their own.
    read_geometry(*scene, {file_, scale_, node, node + 1, Affine<double>(), checkpoint_}, kLeavesOutNothing);
    return scene;
}

std::vector<Instance> SceneObjects::finish(const Scene& materials) {
    std::set<Scene*> done;
    std::vector<Instance> instances;
    for (auto& [scene, instance] : instances_) {
        checkpoint_.pass();
        if (done.insert(scene.get()).second) keep_used_materials(*scene, materials);
        instance.object = scene;
        instances.push_back(instance);
    }
    return instances;
}

/// Removes the textures whose set of texture coordinates the scene's vertices lack.
void forget_textures(Material& material, const Scene& scene) {
    for (const auto member : kMaterialTextures) {
        TextureReference& texture = material.*member;
        if ((texture.uv_set == 0 ? scene.uvs : scene.second_uvs).empty()) texture = {};
    }
}

void keep_all_materials(Scene& scene, Scene from) {
    scene.materials = std::move(from.materials);
    scene.material_names = std::move(from.material_names);
    scene.textures = std::move(from.textures);
    for (Material& material : scene.materials) forget_textures(material, scene);
}

void keep_used_materials(Scene& scene, const Scene& from) {
    std::map<std::uint32_t, std::uint32_t> materials;
    std::map<std::int32_t, std::int32_t> textures;
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
        forget_textures(material, scene);
        for (const auto member : kMaterialTextures) {
            std::int32_t& number = (material.*member).texture;
            if (number < 0) continue;
            const auto [texture, is_new] =
                textures.try_emplace(number, static_cast<std::int32_t>(scene.textures.size()));
            if (is_new) scene.textures.push_back(from.textures[static_cast<std::size_t>(number)]);
            number = texture->second;
        }
    }
    scene.materials = std::move(used);
}

}  // namespace realcam::io
