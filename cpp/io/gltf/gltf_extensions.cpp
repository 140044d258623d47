#include "gltf_extensions.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include "../text/printable.hpp"

namespace realcam::io {
namespace {

constexpr std::array kRead = std::to_array<std::string_view>(
    {"EXT_mesh_gpu_instancing", "EXT_texture_webp", "KHR_lights_punctual", "KHR_materials_clearcoat",
     "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_pbrSpecularGlossiness",
     "KHR_materials_specular", "KHR_materials_transmission", "KHR_materials_unlit", "KHR_materials_volume",
     "KHR_mesh_quantization", "KHR_texture_transform"});

/// Extensions of materials, found also if a file does not list them.
constexpr std::array kOfMaterials =
    std::to_array<std::string_view>({"KHR_materials_anisotropy", "KHR_materials_diffuse_transmission",
                                     "KHR_materials_dispersion", "KHR_materials_iridescence", "KHR_materials_sheen"});

}  // namespace

void warn_of_extensions(FileScene& scene, const GltfDocument& document) {
    std::set<std::string> names;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        const Json& listed = document.root()[list];
        for (std::size_t i = 0; i < listed.size(); ++i) {
            const std::string& name = listed[i].text();
            const bool is_read = std::find(kRead.begin(), kRead.end(), name) != kRead.end();
            if (!is_read && !name.empty()) names.insert(printable(name.substr(0, 60)));
        }
    }
    const Json& materials = document.root()["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
        for (const std::string_view name : kOfMaterials)
            if (!materials[i]["extensions"][name].is_null()) names.emplace(name);
    for (const std::string& name : names) scene.warnings.push_back("the extension " + name + " is not modelled");
}

}  // namespace realcam::io
