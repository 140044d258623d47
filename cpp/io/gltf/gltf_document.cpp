#include "gltf_document.hpp"

#include <cstdint>
#include <stdexcept>
#include <utility>

#include "../../error.hpp"
#include "../text/printable.hpp"
#include "gltf_compression.hpp"

namespace realcam::io {
namespace {

constexpr std::size_t kGlbHeader = 12, kChunkHeader = 8;  // in bytes

/// True for the extensions that may be listed in extensionsRequired: those that are supported, and those without which
/// materials look different.
bool may_be_required(std::string_view extension) {
    return extension == "KHR_lights_punctual" || extension == "KHR_texture_transform" ||
           extension == "KHR_mesh_quantization" || extension == "EXT_mesh_gpu_instancing" ||
           extension == "EXT_texture_webp" || extension == kDraco || extension == kMeshopt[0] ||
           extension == kMeshopt[1] || extension.starts_with("KHR_materials_");
}

/// Returns advice for a file that requires an unsupported extension.
std::string advice(std::string_view extension) {
    if (extension == "KHR_texture_basisu") return "export its KTX2 pictures as PNG, JPEG or WebP";
    if (extension.find("_texture_") != std::string_view::npos) return "export its pictures as PNG or JPEG";
    return "export it without that extension";
}

/// Returns the little-endian 32-bit number at an offset.
std::size_t uint32_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = 256 * value + static_cast<unsigned char>(bytes[offset + i]);
    return value;
}

}  // namespace

std::string gltf_label(const std::string& kind, std::size_t index, const Json& element) {
    const std::string& name = element["name"].text();
    return kind + ' ' + std::to_string(index) + (name.empty() ? "" : ' ' + in_quotes(name));
}

void GltfDocument::fail(const std::string& message) const {
    throw SceneFileError(path_ + ": " + message);
}

// A GLB is a header of 12 bytes (magic, version and size of the file, four bytes each) and chunks of a length, a type
// (four bytes each) and their bytes; the first chunk is JSON, and the second, if present, binary.
std::string_view GltfDocument::json_text() {
    const std::string_view file = file_;
    if (!file.starts_with("glTF")) return file.substr(file.starts_with("\xef\xbb\xbf") ? 3 : 0);
    const auto require_size = [&](std::size_t size) {
        if (size > file.size())
            fail("is cut short: " + std::to_string(file.size()) + " of " + std::to_string(size) + " bytes");
    };
    if (file.size() < kGlbHeader + kChunkHeader) fail("ends inside the header of a GLB");
    if (uint32_at(file, 4) != 2) fail("is glTF " + std::to_string(uint32_at(file, 4)) + "; expected glTF 2.0");
    require_size(uint32_at(file, 8));
    if (file.substr(kGlbHeader + 4, 4) != "JSON") fail("the first chunk must be JSON");
    const std::size_t begin = kGlbHeader + kChunkHeader, size = uint32_at(file, kGlbHeader), end = begin + size;
    require_size(end);
    if (file.size() >= end + kChunkHeader && file.substr(end + 4, 4) == std::string_view("BIN\0", 4)) {
        binary_begin_ = end + kChunkHeader;
        binary_size_ = uint32_at(file, end);
        require_size(binary_begin_ + binary_size_);
    }
    // The specification requires spaces as padding, but many writers use zeros.
    const std::string_view json = file.substr(begin, size);
    return json.substr(0, json.find_last_not_of('\0') + 1);
}

GltfDocument::GltfDocument(const std::string& path, std::string bytes, Checkpoint& checkpoint)
    : path_(path), file_(std::move(bytes)) {
    try {
        root_ = Json::parse(json_text(), checkpoint);
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& error) {
        fail(std::string("is not valid glTF: ") + error.what());
    }
    if (binary_size_ == 0) file_ = {};
    const std::string& version = root_["asset"]["version"].text();
    if (!version.starts_with('2'))
        fail("is glTF " + (version.empty() ? "without a version" : in_quotes(version)) + "; expected glTF 2.0");
    const Json& required = root_["extensionsRequired"];
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (may_be_required(required[i].text())) continue;
        fail("needs the glTF extension " + printable(required[i].text().substr(0, 60)) + ", which is not read; " +
             advice(required[i].text()));
    }
}

std::optional<std::size_t> GltfDocument::find(const char* list, const Json& reference, const std::string& where) const {
    if (reference.is_null()) return std::nullopt;
    const std::size_t count = root_[list].size(), index = reference.index(count);
    if (index < count) return index;
    fail(where + ": expected an index of \"" + list + "\", of which there are " + std::to_string(count));
}

}  // namespace realcam::io
