#include "gltf_readers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include "../text/printable.hpp"

namespace realcam::io {
namespace {

constexpr double kRightAngle = 1.57079632679489662;

/// True if two angles are equal up to rounding to float, so that angles just outside their range are accepted.
bool is_about(double a, double b) {
    return std::abs(a - b) < 1e-6;
}

/// Reads the cone angles of a spot light and clamps them to their range. Returns false if they were outside.
bool read_cone(FileLight& light, const Json& spot) {
    const double outer = spot["outerConeAngle"].number(light.outer_cone_angle);
    const double inner = spot["innerConeAngle"].number(light.inner_cone_angle);
    light.outer_cone_angle = std::clamp(outer, 0.0, kRightAngle);
    light.inner_cone_angle = std::clamp(inner, 0.0, light.outer_cone_angle);
    return is_about(outer, light.outer_cone_angle) && is_about(inner, light.inner_cone_angle);
}

}  // namespace

void read_gltf_lights(FileScene& scene, const GltfDocument& document) {
    const Json& lights = document.root()["extensions"]["KHR_lights_punctual"]["lights"];
    std::size_t bad_cones = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double intensity = lights[i]["intensity"].number(1);
        const Json& colour = lights[i]["color"];
        FileLight light;
        light.type = lights[i]["type"].text();
        light.strength = {intensity * colour[std::size_t{0}].number(1), intensity * colour[1].number(1),
                          intensity * colour[2].number(1)};
        if (light.type == "spot" && !read_cone(light, lights[i]["spot"])) ++bad_cones;
        scene.lights.push_back(std::move(light));
    }
    if (bad_cones > 0)
        scene.warnings.push_back(std::to_string(bad_cones) +
                                 " spots have invalid angles; expected 0 <= innerConeAngle < outerConeAngle <= pi / 2, "
                                 "and the nearest valid angles are used");
}

void read_gltf_cameras(FileScene& scene, const GltfDocument& document) {
    const Json& cameras = document.root()["cameras"];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        FileCamera camera;
        camera.name = printable(cameras[i]["name"].text());
        const double field = cameras[i]["perspective"]["yfov"].number(0);
        if (cameras[i]["type"].text() != "orthographic" && field > 0 && field < std::numbers::pi)
            camera.vertical_field_rad = field;
        scene.cameras.push_back(camera);
    }
}

namespace {

/// Supported extensions.
constexpr std::array kSupported = std::to_array<std::string_view>(
    {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp", "KHR_draco_mesh_compression",
     "KHR_lights_punctual", "KHR_materials_clearcoat", "KHR_materials_emissive_strength", "KHR_materials_ior",
     "KHR_materials_pbrSpecularGlossiness", "KHR_materials_specular", "KHR_materials_transmission",
     "KHR_materials_unlit", "KHR_materials_volume", "KHR_materials_volume_scatter", "KHR_mesh_quantization",
     "KHR_meshopt_compression", "KHR_texture_transform"});

/// Unsupported extensions of materials, for which a warning is given even if the file does not list them.
constexpr std::array kUnsupportedMaterials =
    std::to_array<std::string_view>({"KHR_materials_anisotropy", "KHR_materials_diffuse_transmission",
                                     "KHR_materials_dispersion", "KHR_materials_iridescence", "KHR_materials_sheen"});

}  // namespace

void warn_of_extensions(FileScene& scene, const GltfDocument& document) {
    std::set<std::string> names;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const Json& listed = document.root()[list];
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const std::string& name = listed[i].text();
            const bool is_supported = std::find(kSupported.begin(), kSupported.end(), name) != kSupported.end();
            if (!is_supported && !name.empty()) names.insert(printable(name.substr(0, 60)));
        }
    }
    const Json& materials = document.root()["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
        for (const std::string_view name : kUnsupportedMaterials)
            if (!materials[i]["extensions"][name].is_null()) names.emplace(name);
    for (const std::string& name : names) scene.warnings.push_back("the extension " + name + " is not modelled");
}

}  // namespace realcam::io
