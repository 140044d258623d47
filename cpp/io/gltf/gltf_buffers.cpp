#include "gltf_buffers.hpp"

#include <optional>
#include <utility>

#include "../../error.hpp"
#include "../files/regular_file.hpp"
#include "../files/uri.hpp"
#include "../text/printable.hpp"
#include "gltf_compression.hpp"
#include "gltf_readers.hpp"

namespace realcam::io {

std::string GltfBuffers::read_buffer(std::size_t index, std::size_t size) {
    const std::string& uri = document_.root()["buffers"][index]["uri"].text();
    const std::string label = "buffer " + std::to_string(index);
    if (is_data_uri(uri)) {
        std::optional<std::string> data = data_of_uri(uri);
        if (!data) document_.fail(label + ": its data: address is not valid base64");
        return std::move(*data);
    }
    const std::optional<std::string> file = find_beside(document_.path(), uri);
    if (!file)
        document_.fail(label + " cannot be read: " + (uri.empty() ? "it has no bytes" : in_quotes(uri)) +
                       (uri.empty() ? "" : ": no such file beside the scene"));
    try {
        return read_whole_file(*file, checkpoint_, size);
    } catch (const FileError& error) {
        document_.fail(label + " cannot be read: " + in_quotes(uri) + ": " + error.reason);
    }
}

std::string_view GltfBuffers::buffer(std::size_t index) {
    const Json& buffer = document_.root()["buffers"][index];
    const std::size_t size = buffer["byteLength"].index(0);
    std::string_view bytes = document_.binary_chunk();
    if (!buffer["uri"].is_null() || index != 0 || bytes.empty()) {
        auto found = read_.find(index);
        if (found == read_.end()) found = read_.emplace(index, read_buffer(index, size)).first;
        bytes = found->second;
    }
    if (bytes.size() < size)
        document_.fail("buffer " + std::to_string(index) + ": is cut short: " + std::to_string(bytes.size()) + " of " +
                       std::to_string(size) + " bytes");
    return bytes.substr(0, size);
}

std::string_view GltfBuffers::view(const Json& reference, const std::string& where) {
    const std::optional<std::size_t> index = document_.find("bufferViews", reference, where);
    if (!index) document_.fail(where + ": names no bufferView");
    const Json& view = document_.root()["bufferViews"][*index];
    const std::string label = where + ": bufferView " + std::to_string(*index);
    for (const char* extension : kMeshopt) {
        const Json& compression = view["extensions"][extension];
        if (compression.is_null()) continue;
        const Json& buffers = document_.root()["buffers"];
        const Json& buffer = buffers[view["buffer"].index(buffers.size())];
        // There may be uncompressed bytes beside the compressed ones; otherwise the buffer is only declared.
        const bool has_uncompressed = !buffer["uri"].is_null() || buffer["extensions"][extension].is_null();
        const bool is_missing = !missing_library(extension).empty();
        if (is_missing && has_uncompressed) continue;
        auto found = decoded_.find(*index);
        if (found == decoded_.end()) {
            // Without the library, decoding fails and names it.
            const std::string_view encoded = is_missing ? std::string_view() : slice(compression, label);
            found = decoded_.emplace(*index, decode_meshopt(document_, compression, encoded, label)).first;
        }
        return found->second;
    }
    return slice(view, label);
}

std::string_view GltfBuffers::slice(const Json& view, const std::string& label) {
    const std::optional<std::size_t> buffer_index = document_.find("buffers", view["buffer"], label);
    if (!buffer_index) document_.fail(label + ": names no buffer");
    const std::string_view bytes = buffer(*buffer_index);
    const std::size_t offset = view["byteOffset"].index(0), size = view["byteLength"].index(0);
    if (offset > bytes.size() || size > bytes.size() - offset)
        document_.fail(label + ": reaches beyond the " + std::to_string(bytes.size()) + " bytes of its buffer");
    return bytes.substr(offset, size);
}

namespace {

/// Returns the encoded bytes of an embedded image; empty if they cannot be read.
std::string bytes_of(const Json& image, GltfBuffers& buffers, std::size_t index) {
    const std::string& uri = image["uri"].text();
    if (is_data_uri(uri)) return data_of_uri(uri).value_or("");
    try {
        return std::string(buffers.view(image["bufferView"], "image " + std::to_string(index)));
    } catch (const SceneFileError&) {
        return {};  // leads to a checker pattern and a warning, as for any missing picture
    }
}

/// Returns, for each material, true if a mesh has it. All triangles of a glTF primitive have the same material.
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
            scene.pictures.push_back({std::to_string(i) + " (embedded)", true, {}});
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
            const auto index = static_cast<std::size_t>(texture->picture);
            if (index >= images.size() || is_fetched[index]) continue;
            is_fetched[index] = true;
            FilePicture& picture = scene.pictures[index];
            if (picture.is_embedded) picture.bytes = bytes_of(images[index], buffers, index);
        }
    }
}

}  // namespace realcam::io
