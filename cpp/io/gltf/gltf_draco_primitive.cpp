#include "gltf_draco_primitive.hpp"

#include <cstdint>
#include <utility>

#include "gltf_compression.hpp"

namespace realcam::io {
namespace {

/// True if positions and indices of a primitive have uncompressed bytes.
bool has_uncompressed(const GltfDocument& document, const Json& primitive) {
    const Json& accessors = document.root()["accessors"];
    for (const Json* reference : {&primitive["attributes"]["POSITION"], &primitive["indices"]}) {
        const Json& accessor = accessors[reference->index(accessors.size())];
        if (!accessor.is_null() && accessor["bufferView"].is_null() && accessor["sparse"].is_null()) return false;
    }
    return true;
}

}  // namespace

DecodedAccessors decode_primitive(const GltfDocument& document, GltfBuffers& buffers, const Json& primitive,
                                  const std::vector<std::string>& names, const std::string& label) {
    const Json& draco = primitive["extensions"][kDraco];
    if (draco.is_null() || (!missing_library(kDraco).empty() && has_uncompressed(document, primitive))) return {};
    const Json &list = document.root()["accessors"], &attributes = primitive["attributes"];
    const auto find = [&](const Json& reference, const std::string& name) {
        const auto index = document.find("accessors", reference, label + ": " + name);
        if (!index) document.fail(label + ": has no " + name + ", which a Draco mesh needs");
        return *index;
    };
    if (primitive["mode"].index(kGltfTriangles) != kGltfTriangles)
        document.fail(label + ": a Draco mesh must have the mode 4, triangles");
    const std::size_t indices = find(primitive["indices"], "indices");
    const DracoSize size{list[find(attributes["POSITION"], "POSITION")]["count"].index(0),
                         list[indices]["count"].index(0) / 3};
    std::vector<DracoAttribute> requests;
    std::vector<std::size_t> accessors;
    for (const std::string& name : names) {
        const Json& id = draco["attributes"][name];
        if (id.is_null()) continue;
        accessors.push_back(find(attributes[name], name));
        const Json& accessor = list[accessors.back()];
        requests.push_back({id.index(0), accessor["componentType"].index(0), components_of(accessor["type"].text())});
    }
    const std::string_view encoded = buffers.view(draco["bufferView"], label + ": its compressed mesh");
    DracoMesh mesh = decode_draco(document, encoded, size, requests, label);
    DecodedAccessors decoded;
    decoded[indices] = {
        std::string(reinterpret_cast<const char*>(mesh.indices.data()), mesh.indices.size() * sizeof(std::uint32_t)),
        kGltfUnsignedInt};
    for (std::size_t i = 0; i < requests.size(); ++i)
        decoded[accessors[i]] = {std::move(mesh.attributes[i]), requests[i].component_type};
    return decoded;
}

}  // namespace realcam::io
