#include "scene_objects.hpp"

#include <algorithm>

#include "../error.hpp"
#include "nearest_names.hpp"
#include "scene_geometry.hpp"
#include "scene_lights.hpp"

namespace realcam::io {
namespace {

bool has_meshes(const aiNode& node) {
    bool found = node.mNumMeshes > 0;
    for (unsigned i = 0; i < node.mNumChildren; ++i) found |= has_meshes(*node.mChildren[i]);
    return found;
}

std::size_t triangle_count(const aiScene& content, const std::vector<unsigned>& meshes) {
    std::size_t count = 0;
    for (const unsigned m : meshes) count += content.mMeshes[m]->mNumFaces;
    return count;
}

}  // namespace

SceneObjects::SceneObjects(const ImportedScene& file, const std::string& path, double scale,
                           const std::vector<std::string>& names)
    : file_(file), path_(path), scale_(scale), names_(names) {
    std::map<Meshes, std::size_t> uses;
    std::set<std::string> found;
    if (file.content().mRootNode) count_uses(*file.content().mRootNode, uses, found);
    for (const std::string& name : names)
        if (!found.contains(name))
            throw SceneFileError(path + ": has no node \"" + name + '"' +
                                 did_you_mean(name, {found.begin(), found.end()}));
    for (const auto& [meshes, times] : uses)
        if ((times - 1) * triangle_count(file.content(), meshes) >= kSharedTriangles) shared_.insert(meshes);
}

void SceneObjects::count_uses(const aiNode& node, std::map<Meshes, std::size_t>& uses,
                              std::set<std::string>& found) const {
    found.insert(node.mName.C_Str());
    if (node.mNumMeshes > 0) ++uses[meshes_of(node)];
    for (unsigned i = 0; i < node.mNumChildren; ++i) count_uses(*node.mChildren[i], uses, found);
}

LeftOut SceneObjects::left_out(const aiNode& node, const Affine<double>& transform) const {
    if (std::find(names_.begin(), names_.end(), node.mName.C_Str()) != names_.end()) return LeftOut::all;
    // What is scaled to nothing, as animations hide nodes, has no triangles in static geometry, and no place as an
    // object.
    const bool shared = node.mNumMeshes > 0 && shared_.contains(meshes_of(node)) && transform_error(transform).empty();
    return shared ? LeftOut::meshes : LeftOut::nothing;
}

void SceneObjects::add(const aiNode& node, const Affine<double>& transform, Scene& static_geometry) {
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
    instances_.push_back({scene, {nullptr, place, node.mName.C_Str()}});
}

std::shared_ptr<Scene> SceneObjects::read_object(const aiNode& node, const Affine<double>& transform,
                                                 Scene& static_geometry) const {
    const LeavesOut nothing = [](const aiNode&, const Affine<double>&) { return LeftOut::nothing; };
    auto scene = std::make_shared<Scene>();
    const ScenePart part{file_, path_, scale_, node};
    read_lights(*scene, part, nothing);
    if (has_meshes(node))
        read_geometry(*scene, part, nothing);
    else if (scene->points.empty())
        throw SceneFileError(path_ + ": node \"" + node.mName.C_Str() + "\" holds neither triangles nor a light");
    // A sun has no place: it shines on all, from where it does now.
    Scene in_place;
    read_lights(in_place, {file_, path_, scale_, node, transform}, nothing);
    static_geometry.suns.insert(static_geometry.suns.end(), in_place.suns.begin(), in_place.suns.end());
    scene->suns.clear();
    return scene;
}

std::shared_ptr<Scene> SceneObjects::read_meshes(const aiNode& node) const {
    auto scene = std::make_shared<Scene>();
    read_geometry(*scene, {file_, path_, scale_, node}, [&node](const aiNode& other, const Affine<double>&) {
        return &other == &node ? LeftOut::nothing : LeftOut::all;  // children stand for themselves
    });
    return scene;
}

std::vector<Instance> SceneObjects::finish(const Scene& materials) {
    std::set<Scene*> done;
    std::vector<Instance> instances;
    for (auto& [scene, instance] : instances_) {
        if (done.insert(scene.get()).second) keep_used_materials(*scene, materials);
        instance.object = scene;
        instances.push_back(instance);
    }
    return instances;
}

void keep_all_materials(Scene& scene, Scene from) {
    scene.materials = std::move(from.materials);
    scene.material_names = std::move(from.material_names);
    scene.textures = std::move(from.textures);
    if (scene.uvs.empty())
        for (Material& material : scene.materials) material.diffuse_texture = -1;
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
        if (scene.uvs.empty()) material.diffuse_texture = -1;
        if (material.diffuse_texture < 0) continue;
        const auto [texture, is_new] =
            textures.try_emplace(material.diffuse_texture, static_cast<std::int32_t>(scene.textures.size()));
        if (is_new) scene.textures.push_back(from.textures[static_cast<std::size_t>(material.diffuse_texture)]);
        material.diffuse_texture = texture->second;
    }
    scene.materials = std::move(used);
}

}  // namespace realcam::io
