#include "scene_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "../error.hpp"
#include "../scene/instance_names.hpp"
#include "ply_file.hpp"
#include "scene_checks.hpp"
#include "scene_geometry.hpp"
#include "scene_import.hpp"
#include "scene_lights.hpp"
#include "scene_materials.hpp"
#include "scene_objects.hpp"
#include "scene_textures.hpp"

namespace realcam::io {
namespace {

namespace fs = std::filesystem;

std::string suffix_of(const std::string& path) {
    std::string suffix = fs::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    if (suffix == ".obj" || suffix == ".gltf" || suffix == ".glb" || suffix == ".ply") return suffix;
    throw SceneFileError(path + ": a scene file ends in .glb, .gltf, .obj or .ply" +
                         (suffix.empty() ? "" : ", not in " + suffix));
}

void check_readable(const std::string& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) throw SceneFileError(path + ": no such file");
    if (fs::is_directory(status)) throw SceneFileError(path + ": is a folder; a scene file is wanted");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SceneFileError(path + ": cannot be opened; permission to read it is wanted");
    if (file.peek() == std::ifstream::traits_type::eof()) {
        throw SceneFileError(path + ": is empty; a scene with triangles is wanted");
    }
}

Scene read_ply_scene(const std::string& path, double scale, const ImageReader& read_image) {
    Scene scene;
    scene.materials = {Material{}};
    const std::string texture = read_ply(scene, path, scale);
    if (!texture.empty() && !scene.uvs.empty()) {
        SceneTextures textures(scene, nullptr, path, read_image);
        scene.materials[0] = {{1, 1, 1}, {0, 0, 0}, 0, {0, 0, 0}, textures.find(texture).index};
    }
    return scene;
}

Assembly read_other_scene(const std::string& path, SceneFormat format, const SceneFileOptions& options,
                          const ImageReader& read_image) {
    const ImportedScene file(path, format);
    Scene static_geometry, materials;
    for (const std::string& complaint : file.complaints()) static_geometry.warnings.push_back(path + ": " + complaint);
    SceneTextures textures(materials, &file.content(), path, read_image);
    read_materials(materials, file, textures, path);
    static_geometry.warnings.insert(static_geometry.warnings.end(), materials.warnings.begin(),
                                    materials.warnings.end());

    SceneObjects objects(file, path, options.scale, options.objects);
    const aiNode& root = *file.content().mRootNode;
    const ScenePart all{file, path, options.scale, root, file.transform(root)};
    read_geometry(static_geometry, all, [&](const aiNode& node, const Affine<double>& transform) {
        const LeftOut left_out = objects.left_out(node, transform);
        if (left_out != LeftOut::nothing) objects.add(node, transform, static_geometry);
        return left_out;
    });
    read_lights(static_geometry, all,
                [&](const aiNode& node, const Affine<double>& transform) { return objects.left_out(node, transform); });
    std::vector<Instance> instances = objects.finish(materials);
    if (instances.empty())
        keep_all_materials(static_geometry, std::move(materials));
    else
        keep_used_materials(static_geometry, materials);
    Assembly scene(std::move(static_geometry));
    scene.instances = std::move(instances);
    make_names_distinct(scene);
    return scene;
}

}  // namespace

Assembly read_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image) {
    if (!std::isfinite(options.scale) || !(options.scale > 0)) {
        throw InputError("scale must be a positive number of metres per unit of the file, not " +
                         std::to_string(options.scale));
    }
    const std::string suffix = suffix_of(path);
    check_readable(path);
    if (suffix == ".ply" && !options.objects.empty())
        throw InputError(path + ": a .ply file has no nodes that could be objects");
    Assembly scene = suffix == ".ply" ? read_ply_scene(path, options.scale, read_image)
                                      : read_other_scene(path, suffix == ".obj" ? SceneFormat::obj : SceneFormat::gltf,
                                                         options, read_image);
    validate(scene, path);
    return scene;
}

}  // namespace realcam::io
