#include "scene_objects.hpp"

#include <algorithm>

#include "../error.hpp"
#include "nearest_names.hpp"
#include "printable.hpp"
#include "scene_geometry.hpp"
#include "scene_lights.hpp"

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
    if (names_.contains(file_.nodes[node].name)) return LeftOut::all;
    // What is scaled to nothing, as animations hide nodes, has no triangles in static geometry, and no place as an
    // object.
    const bool is_shared =
        file_.nodes[node].mesh_count > 0 && shared_.contains(meshes_of(node)) && transform_error(transform).empty();
    return is_shared ? LeftOut::meshes : LeftOut::nothing;
}

void SceneObjects::add(std::uint32_t node, const Affine<double>& transform, Scene& static_geometry) {
    std::shared_ptr<Scene> scene;
    if (left_out(node, transform) == LeftOut::all) {
        scene = read_object(node, transform, static_geometry);
    } else {
        std::shared_ptr<Scene>& shared = shared_scenes_[meshes_of(node)];
        if (!shared) shared = read_meshes(node);
        scene = shared;
    }
    static_geometry.warnings.insert(static_geometry.warnings.end(), scene->warnings.begin(), scene->warnings.end());
    scene->warnings.clear();
    Affine<double> place = transform;
    place.origin = scale_ * place.origin;
    instances_.push_back({scene, {nullptr, place, file_.nodes[node].name}});
}

std::shared_ptr<Scene> SceneObjects::read_object(std::uint32_t node, const Affine<double>& transform,
                                                 Scene& static_geometry) const {
    auto scene = std::make_shared<Scene>();
    const std::uint32_t end = file_.nodes[node].end;
    const ScenePart part{file_, scale_, node, end, Affine<double>(), checkpoint_};
    read_lights(*scene, part, kLeavesOutNothing);
    if (has_triangles(file_, node))
        read_geometry(*scene, part, kLeavesOutNothing);
    else if (scene->points.empty())
        throw SceneFileError(file_.path + ": node " + in_quotes(file_.nodes[node].name) +
                             " holds neither triangles nor a light");
    // A sun has no place: it lights all, from where it does now.
    Scene in_place;
    read_lights(in_place, {file_, scale_, node, end, transform, checkpoint_}, kLeavesOutNothing);
    static_geometry.suns.insert(static_geometry.suns.end(), in_place.suns.begin(), in_place.suns.end());
    scene->suns.clear();
    return scene;
}

std::shared_ptr<Scene> SceneObjects::read_meshes(std::uint32_t node) const {
    auto scene = std::make_shared<Scene>();
    // Without what is below the node, which stands for itself.
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

void forget_textures(Material& material) {
    for (const auto member : kMaterialTextures) material.*member = {};
}

void keep_all_materials(Scene& scene, Scene from) {
    scene.materials = std::move(from.materials);
    scene.material_names = std::move(from.material_names);
    scene.textures = std::move(from.textures);
    if (scene.uvs.empty())
        for (Material& material : scene.materials) forget_textures(material);
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
        if (scene.uvs.empty()) forget_textures(material);
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
