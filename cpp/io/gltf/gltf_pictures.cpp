#include "gltf_pictures.hpp"

#include "../../error.hpp"
#include "../files/uri.hpp"

namespace realcam::io {
namespace {

std::string bytes_of(const Json& image, GltfBuffers& buffers, std::size_t number) {
    const std::string& uri = image["uri"].text();
    if (is_data_uri(uri)) return data_of_uri(uri).value_or("");
    try {
        return std::string(buffers.view(image["bufferView"], "image " + std::to_string(number)));
    } catch (const SceneFileError&) {
        return {};  // leads to a stand-in and a warning, as for any missing picture
    }
}

std::vector<bool> used_materials(const FileScene& scene) {
    std::vector<bool> is_used(scene.materials.size(), false);
    for (const FileMesh& mesh : scene.meshes)
        if (!mesh.triangles.empty()) is_used[mesh.triangles.front().material] = true;
    return is_used;
}

}  // namespace

void list_pictures(FileScene& scene, const GltfDocument& document) {
    const Json& images = document.root()["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string& uri = images[i]["uri"].text();
        if (uri.empty() || is_data_uri(uri))
            scene.pictures.push_back({std::to_string(i) + " inside it", true, {}});
        else
            scene.pictures.push_back({uri, false, {}});
    }
}

void fetch_pictures(FileScene& scene, const GltfDocument& document, GltfBuffers& buffers) {
    const Json& images = document.root()["images"];
    const std::vector<bool> is_used = used_materials(scene);
    std::vector<bool> is_fetched(scene.pictures.size(), false);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const auto* material = std::get_if<GltfMaterial>(&scene.materials[m].content);
        if (!material || !is_used[m]) continue;
        for (const FileTexture* texture : material->textures()) {
            const auto number = static_cast<std::size_t>(texture->picture);
            if (number >= images.size() || is_fetched[number]) continue;
            is_fetched[number] = true;
            FilePicture& picture = scene.pictures[number];
            if (picture.is_inside) picture.bytes = bytes_of(images[number], buffers, number);
        }
    }
}

}  // namespace realcam::io
