#include "gltf_materials.hpp"

#include <algorithm>
#include <utility>

#include "../error.hpp"
#include "printable.hpp"
#include "uri.hpp"

namespace realcam::io {
namespace {

float number_of(const Json& json, float otherwise) {
    return static_cast<float>(json.number(static_cast<double>(otherwise)));
}

Vec3f colour_of(const Json& json, Vec3f otherwise) {
    return {number_of(json[std::size_t{0}], otherwise.x), number_of(json[1], otherwise.y),
            number_of(json[2], otherwise.z)};
}

class MaterialParser {
public:
    MaterialParser(FileScene& scene, const GltfDocument& document) : scene_(scene), root_(document.root()) {}

    void parse_pictures() {
        const Json& images = root_["images"];
        for (std::size_t i = 0; i < images.size(); ++i) {
            const std::string& uri = images[i]["uri"].text();
            if (uri.empty() || is_data_uri(uri))
                scene_.pictures.push_back({std::to_string(i) + " inside it", true, {}});
            else
                scene_.pictures.push_back({uri, false, {}});
        }
    }

    GltfMaterial parse(const Json& json) {
        GltfMaterial out;
        const Json& pbr = json["pbrMetallicRoughness"];
        out.base_color_factor = colour_of(pbr["baseColorFactor"], out.base_color_factor);
        out.alpha = number_of(pbr["baseColorFactor"][3], out.alpha);
        out.metallic_factor = number_of(pbr["metallicFactor"], out.metallic_factor);
        out.roughness_factor = number_of(pbr["roughnessFactor"], out.roughness_factor);
        out.base_color_texture = texture(pbr["baseColorTexture"]);
        out.metallic_roughness_texture = texture(pbr["metallicRoughnessTexture"]);
        out.emissive_factor = colour_of(json["emissiveFactor"], out.emissive_factor);
        out.emissive_texture = texture(json["emissiveTexture"]);
        if (!json["alphaMode"].is_null()) out.alpha_mode = json["alphaMode"].text();
        const Json& extensions = json["extensions"];
        out.emissive_strength = number_of(extensions["KHR_materials_emissive_strength"]["emissiveStrength"], 1);
        const Json& older = extensions["KHR_materials_pbrSpecularGlossiness"];
        if (!older.is_null()) out.specular_glossiness = parse_specular_glossiness(older);
        return out;
    }

private:
    GltfSpecularGlossiness parse_specular_glossiness(const Json& json) {
        GltfSpecularGlossiness out;
        out.diffuse_factor = colour_of(json["diffuseFactor"], out.diffuse_factor);
        out.alpha = number_of(json["diffuseFactor"][3], out.alpha);
        out.specular_factor = colour_of(json["specularFactor"], out.specular_factor);
        out.glossiness_factor = number_of(json["glossinessFactor"], out.glossiness_factor);
        out.diffuse_texture = texture(json["diffuseTexture"]);
        return out;
    }

    /// `info`: the place in a material that names a texture; null where it has none.
    FileTexture texture(const Json& info) {
        if (info.is_null()) return {};
        const Json& moved = info["extensions"]["KHR_texture_transform"];
        const Json &scale = moved["scale"], &offset = moved["offset"];
        const Json& set = moved["texCoord"].is_number() ? moved["texCoord"] : info["texCoord"];
        FileTexture out;
        out.picture = picture_of(info["index"]);
        out.uv_set = static_cast<std::uint32_t>(std::min<std::size_t>(set.index(0), 0xffff));
        out.transform = {scale[std::size_t{0}].number(1), scale[1].number(1), moved["rotation"].number(0),
                         offset[std::size_t{0}].number(0), offset[1].number(0)};
        return out;
    }

    /// A texture that names no picture gets one without bytes, which stands out in the picture and is warned of.
    std::int32_t picture_of(const Json& texture) {
        const Json& source = root_["textures"][texture.index(root_["textures"].size())]["source"];
        const std::size_t images = root_["images"].size(), number = source.index(images);
        if (number < images) return static_cast<std::int32_t>(number);
        if (missing_ < 0) {
            missing_ = static_cast<std::int32_t>(scene_.pictures.size());
            scene_.pictures.push_back({"without a picture", true, {}});
        }
        return missing_;
    }

    FileScene& scene_;
    const Json& root_;
    std::int32_t missing_ = -1;
};

std::string bytes_of(const Json& image, GltfBuffers& buffers, std::size_t number) {
    const std::string& uri = image["uri"].text();
    if (is_data_uri(uri)) return data_of_uri(uri).value_or("");
    try {
        return std::string(buffers.view(image["bufferView"], "image " + std::to_string(number)));
    } catch (const SceneFileError&) {
        return {};  // a stand-in and a warning follow, as for any picture that cannot be had
    }
}

}  // namespace

void read_gltf_materials(FileScene& scene, const GltfDocument& document) {
    MaterialParser parser(scene, document);
    parser.parse_pictures();
    const Json& materials = document.root()["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
        scene.materials.push_back({materials[i]["name"].text(), parser.parse(materials[i])});
}

void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers) {
    std::vector<bool> is_used(scene.materials.size(), false);
    for (const FileMesh& mesh : scene.meshes)
        if (!mesh.triangles.empty()) is_used[mesh.triangles.front().material] = true;
    std::vector<bool> is_fetched(scene.pictures.size(), false);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const auto* material = std::get_if<GltfMaterial>(&scene.materials[m].content);
        if (!material || !is_used[m]) continue;
        for (const FileTexture& texture :
             {scene.materials[m].colour_texture(), material->metallic_roughness_texture, material->emissive_texture}) {
            const auto number = static_cast<std::size_t>(texture.picture);
            if (!texture || number >= document.root()["images"].size() || is_fetched[number]) continue;
            is_fetched[number] = true;
            FilePicture& picture = scene.pictures[number];
            if (picture.is_inside) picture.bytes = bytes_of(document.root()["images"][number], buffers, number);
        }
    }
}

void read_gltf_lights(FileScene& scene, const GltfDocument& document) {
    const Json& lights = document.root()["extensions"]["KHR_lights_punctual"]["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double intensity = lights[i]["intensity"].number(1);
        const Json& colour = lights[i]["color"];
        scene.lights.push_back({lights[i]["type"].text(),
                                {intensity * colour[std::size_t{0}].number(1), intensity * colour[1].number(1),
                                 intensity * colour[2].number(1)}});
    }
}

}  // namespace realcam::io
