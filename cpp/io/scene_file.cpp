#include "scene_file.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include "../error.hpp"
#include "../scene/assembly.hpp"
#include "../scene/scene_checks.hpp"
#include "files/regular_file.hpp"
#include "files/uri.hpp"
#include "gltf/gltf_file.hpp"
#include "gltf/gltf_nodes.hpp"
#include "mesh/obj_file.hpp"
#include "mesh/ply_file.hpp"
#include "scene/decoded_image.hpp"
#include "scene/scene_geometry.hpp"
#include "scene/scene_objects.hpp"
#include "scene/scene_textures.hpp"
#include "stage_reader.hpp"
#include "text/printable.hpp"

namespace realcam::io {
namespace {

/// Throws FileError or SceneFileError if the file cannot be read, is empty, or is larger than the free memory: readers
/// of all formats need at least the file's size.
void check_file(const std::string& path) {
    const std::uint64_t size = RegularFile(path).size();
    if (size == 0) throw SceneFileError(path + ": is empty; expected a scene with triangles");
    if (const std::string why = too_much_memory(size); !why.empty()) throw SceneFileError(path + ": holds " + why);
}

void append(std::vector<std::string>& warnings, std::vector<std::string> new_warnings) {
    warnings.insert(warnings.end(), std::make_move_iterator(new_warnings.begin()),
                    std::make_move_iterator(new_warnings.end()));
}

/// Limits the number of warnings, because a file may have a million errors.
void limit_warnings(std::vector<std::string>& warnings, const std::string& path) {
    constexpr std::size_t kMaxWarnings = 50;
    if (warnings.size() <= kMaxWarnings) return;
    const std::size_t left_out = warnings.size() - (kMaxWarnings - 1);
    warnings.resize(kMaxWarnings - 1);
    warnings.push_back(path + ": and " + std::to_string(left_out) + " warnings more");
}

/// Reads a PLY file, whose textures become materials.
Assembly read_ply_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image,
                        Checkpoint& checkpoint) {
    if (!options.objects.empty()) throw InputError(path + ": a .ply file has no nodes that could be objects");
    Scene scene;
    FileScene file;
    file.path = path;
    for (const std::string& name : read_ply(scene, path, options.scale, checkpoint))
        file.pictures.push_back({name, false, {}});
    Material default_material;
    // Vertex colours are the surface's own colours.
    if (!scene.colors.empty()) default_material.diffuse = {1, 1, 1};
    default_material.vertex_opacity = are_transparent(scene.colors);
    Scene materials;
    materials.materials.assign(file.pictures.size() + 1, default_material);
    if (!file.pictures.empty() && scene.uvs.empty())
        scene.warnings.push_back(path + ": names a texture, and has no texture coordinates, which a texture needs");
    SceneTextures textures(materials, file, read_image, checkpoint);
    std::vector<bool> is_used(materials.materials.size(), false);
    for (const Triangle& triangle : scene.triangles) is_used[triangle.material] = true;
    for (std::size_t i = 0; i < file.pictures.size() && !scene.uvs.empty(); ++i) {
        if (!is_used[i]) continue;
        materials.materials[i].diffuse = {1, 1, 1};
        materials.materials[i].diffuse_texture =
            textures.find({static_cast<std::int32_t>(i), 0, {}, {}}, TextureUse::colour).reference;
    }
    append(scene.warnings, std::move(materials.warnings));
    keep_used_materials(scene, materials);
    return scene;
}

/// Returns the cameras of a file's nodes. A camera has the name of its node, or its own name if the node has none.
/// Warnings go to `static_geometry`.
std::vector<SceneCamera> cameras_of(const FileScene& file, SceneObjects& objects, Scene& static_geometry) {
    std::vector<SceneCamera> cameras;
    if (file.cameras.empty()) return cameras;
    DistinctNames names;
    const std::vector<Affine<double>> transforms = global_transforms(file.nodes);
    for (std::uint32_t i = 0; i < file.nodes.size(); ++i) {
        if (file.nodes[i].camera < 0) continue;
        const FileCamera& camera = file.cameras[static_cast<std::size_t>(file.nodes[i].camera)];
        const AnimatedTransform transform = objects.placement(i, transforms[i], static_geometry);
        std::string name = !file.nodes[i].name.empty() ? file.nodes[i].name : camera.name;
        if (name.empty()) name = "camera " + std::to_string(file.nodes[i].camera);
        if (const std::string why = transform_error(transform.scene_from_object); !why.empty()) {
            static_geometry.warnings.push_back(file.path + ": camera " + in_quotes(name) + " is left out: " + why);
            continue;
        }
        cameras.push_back({names.take(name), transform.scene_from_object, camera.vertical_field_rad, transform.motion});
    }
    return cameras;
}

/// Builds the scene of an OBJ or glTF file from its parsed contents.
Assembly assemble(const FileScene& file, const SceneFileOptions& options, const ImageReader& read_image,
                  Checkpoint& checkpoint) {
    Scene static_geometry, materials;
    for (const std::string& warning : file.warnings) static_geometry.warnings.push_back(file.path + ": " + warning);
    SceneTextures textures(materials, file, read_image, checkpoint);
    make_materials(materials, file, options.scale, textures);
    append(static_geometry.warnings, std::move(materials.warnings));

    SceneObjects objects(file, options.scale, options.objects, checkpoint);
    const LeftOutFunction part_left_out = [&](std::uint32_t node, const Affine<double>& transform) {
        return objects.left_out(node, transform);
    };
    const ScenePart whole_scene{file,         options.scale, 0, static_cast<std::uint32_t>(file.nodes.size()),
                                std::nullopt, checkpoint};
    visit_nodes(whole_scene, [&](std::uint32_t node, const Affine<double>& transform) {
        const LeftOut left_out = part_left_out(node, transform);
        if (left_out != LeftOut::nothing) objects.add(node, transform, static_geometry);
        return left_out != LeftOut::all;
    });
    read_geometry(static_geometry, whole_scene, part_left_out);
    read_lights(static_geometry, whole_scene, part_left_out);
    std::vector<SceneCamera> cameras = cameras_of(file, objects, static_geometry);
    std::vector<Instance> instances = objects.finish(materials);
    if (instances.empty())
        keep_all_materials(static_geometry, std::move(materials));
    else
        keep_used_materials(static_geometry, materials);
    limit_warnings(static_geometry.warnings, file.path);
    Assembly scene(std::move(static_geometry));
    scene.instances = std::move(instances);
    scene.cameras = std::move(cameras);
    make_names_distinct(scene);
    return scene;
}

Assembly read_obj_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image,
                        Checkpoint& checkpoint) {
    return assemble(read_obj(path, options.scale, checkpoint), options, read_image, checkpoint);
}

Assembly read_gltf_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image,
                         Checkpoint& checkpoint) {
    return assemble(read_gltf(path, options.scene_name, checkpoint), options, read_image, checkpoint);
}

Assembly read_stage(const std::string& path, const SceneFileOptions& options, const ImageReader&, Checkpoint&) {
    return stage_reader(path).scene(path, options);
}

/// Format of scene files, with its reader.
struct SceneFormat {
    std::string_view suffix;
    Assembly (*read)(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image,
                     Checkpoint& checkpoint);
};

constexpr SceneFormat kFormats[] = {{".glb", &read_gltf_scene}, {".gltf", &read_gltf_scene}, {".obj", &read_obj_scene},
                                    {".ply", &read_ply_scene},  {".usd", &read_stage},       {".usda", &read_stage},
                                    {".usdc", &read_stage},     {".usdz", &read_stage}};

/// Returns the format of a path's suffix. Throws SceneFileError if it is unknown.
const SceneFormat& format_of(const std::string& path) {
    const std::string suffix = suffix_of(path);
    std::string known;
    for (const SceneFormat& format : kFormats) {
        if (format.suffix == suffix) return format;
        known.append(known.empty() ? "" : &format == std::end(kFormats) - 1 ? " or " : ", ").append(format.suffix);
    }
    throw SceneFileError(path + ": a scene file ends in " + known + (suffix.empty() ? "" : ", not in " + suffix));
}

Assembly read_any(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image) {
    Checkpoint checkpoint(options.keep_going);
    // The system has no longer paths, and the message must not repeat all of it.
    if (path.size() > PATH_MAX) throw SceneFileError(in_quotes(path) + ": no such file");
    const SceneFormat& format = format_of(path);
    if (!options.variants.empty() && format.read != &read_stage)
        throw InputError(path + ": variants are selected in a USD stage; this file has none");
    if (!options.scene_name.empty() && format.read != &read_gltf_scene)
        throw InputError(path + ": scenes are selected in a glTF file; this file has one");
    check_file(path);
    return format.read(path, options, read_image, checkpoint);
}

/// Returns read(), after checks of the scale and of the scene. Throws SceneFileError if the file or the memory does not
/// suffice.
template <class Read>
Assembly checked_scene(const std::string& path, const SceneFileOptions& options, Read&& read) {
    if (!std::isfinite(options.scale) || !(options.scale > 0)) {
        throw InputError("scale must be a positive number of metres per unit of the file, not " +
                         std::to_string(options.scale));
    }
    try {
        Assembly scene = read();
        SceneChecks().check(scene, path);
        return scene;
    } catch (const FileError& error) {
        throw SceneFileError(path + ": " + error.reason);
    } catch (const std::bad_alloc&) {
        throw SceneFileError(path + ": there is too little memory for it");
    } catch (const std::length_error&) {
        throw SceneFileError(path + ": there is too little memory for it");
    }
}

}  // namespace

bool is_stage(const std::string& path) {
    const std::string suffix = suffix_of(path);
    return std::any_of(std::begin(kFormats), std::end(kFormats), [&](const SceneFormat& format) {
        return format.suffix == suffix && format.read == &read_stage;
    });
}

Assembly read_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image) {
    return checked_scene(path, options, [&] { return read_any(path, options, read_image); });
}

Assembly read_glb(const std::string& path, std::string glb, std::vector<std::string> warnings,
                  const SceneFileOptions& options, const ImageReader& read_image) {
    return checked_scene(path, options, [&] {
        Checkpoint checkpoint(options.keep_going);
        FileScene file = parse_gltf(path, std::move(glb), {}, checkpoint);
        append(warnings, std::move(file.warnings));
        file.warnings = std::move(warnings);
        return assemble(file, options, read_image, checkpoint);
    });
}

}  // namespace realcam::io
