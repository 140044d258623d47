#include "gltf_compression.hpp"

#if REALCAM_HAS_DRACO
#include <draco/compression/config/compression_shared.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>
#endif

#include <array>
#include <cstring>

#include "../files/regular_file.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

#if REALCAM_HAS_DRACO
namespace {

/// Sum over the attributes of the number of components.
std::size_t components_of(const draco::PointCloud& mesh) {
    std::size_t sum = 0;
    for (int i = 0; i < mesh.num_attributes(); ++i) sum += mesh.attribute(i)->num_components();
    return sum;
}

/// Decoder that refuses attributes that need too much memory, before it allocates memory for them.
template <class Decoder>
class BoundedDecoder : public Decoder {
public:
    explicit BoundedDecoder(std::size_t vertices) : vertices_(vertices) {}

    /// Returns why the attributes were refused; empty if they were not.
    const std::string& refusal() const { return refusal_; }

private:
    bool DecodeAllAttributes() override {
        // A component is stored as coded, as predicted and in its final form.
        constexpr std::size_t kBytesPerComponent = 16;
        const std::size_t components = components_of(*this->point_cloud());
        refusal_ = components > kMaxDracoComponents
                       ? std::to_string(components) + " numbers for each vertex; at most " +
                             std::to_string(kMaxDracoComponents) + " are decoded"
                       : too_much_memory(kBytesPerComponent * components * vertices_);
        return refusal_.empty() && Decoder::DecodeAllAttributes();
    }

    std::size_t vertices_;
    std::string refusal_;
};

/// Beginning of a Draco mesh.
struct DracoHeader {
    bool is_edgebreaker;  ///< the connectivity is coded by Edgebreaker; otherwise it is sequential
    std::uint64_t vertices, triangles;
};

/// Reads the header and the numbers of vertices and triangles, which follow it (Draco bitstream specification 2.2,
/// sections "Header" and "Connectivity"). Throws SceneFileError.
DracoHeader read_header(const GltfDocument& document, std::string_view encoded, const std::string& where) {
    draco::DecoderBuffer buffer;
    buffer.Init(encoded.data(), encoded.size());
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() || header.encoder_type != draco::TRIANGULAR_MESH)
        document.fail(where + ": is not a Draco mesh");
    if (header.version_major != 2 || header.version_minor != 2)
        document.fail(where + ": has Draco's bitstream " + std::to_string(header.version_major) + '.' +
                      std::to_string(header.version_minor) + "; glTF has 2.2");
    buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
    draco::GeometryMetadata metadata;
    const bool has_metadata = (header.flags & METADATA_FLAG_MASK) != 0;
    bool is_read = !has_metadata || draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata);
    const bool is_edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
    std::uint8_t traversal = 0;
    std::uint32_t first = 0, second = 0;
    if (is_edgebreaker) is_read = is_read && buffer.Decode(&traversal);
    is_read = is_read && draco::DecodeVarint(&first, &buffer) && draco::DecodeVarint(&second, &buffer);
    if (!is_read) document.fail(where + ": its Draco mesh is cut short");
    // Edgebreaker begins with the number of vertices, the sequential coding with that of triangles.
    return is_edgebreaker ? DracoHeader{true, first, second} : DracoHeader{false, second, first};
}

/// Appends the elements of an attribute, in the order of the mesh's points. Returns false if the attribute cannot be
/// converted.
template <class Component>
bool copy_elements(const draco::PointAttribute& attribute, std::size_t components, std::size_t points,
                   std::string& to) {
    std::array<Component, 16> element{};
    to.resize(points * components * sizeof(Component));
    char* next = to.data();
    for (std::uint32_t i = 0; i < points; ++i) {
        if (!attribute.ConvertValue<Component>(attribute.mapped_index(draco::PointIndex(i)),
                                               static_cast<std::int8_t>(components), element.data()))
            return false;
        std::memcpy(next, element.data(), components * sizeof(Component));
        next += components * sizeof(Component);
    }
    return true;
}

/// Returns the elements of an attribute as its accessor describes them. Throws SceneFileError.
std::string elements_of(const GltfDocument& document, const draco::Mesh& mesh, const DracoAttribute& request,
                        const std::string& where) {
    const std::string label = where + ": its Draco attribute " + std::to_string(request.id);
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(request.id));
    if (!attribute) document.fail(label + " does not exist");
    if (attribute->num_components() != request.components)
        document.fail(label + " has " + std::to_string(attribute->num_components()) +
                      " components; its accessor expects " + std::to_string(request.components));
    std::string bytes;
    const auto copy = [&]<class Component>() {
        return copy_elements<Component>(*attribute, request.components, mesh.num_points(), bytes);
    };
    bool is_copied = false;
    switch (request.component_type) {
        case kGltfByte: is_copied = copy.operator()<std::int8_t>(); break;
        case kGltfUnsignedByte: is_copied = copy.operator()<std::uint8_t>(); break;
        case kGltfShort: is_copied = copy.operator()<std::int16_t>(); break;
        case kGltfUnsignedShort: is_copied = copy.operator()<std::uint16_t>(); break;
        case kGltfUnsignedInt: is_copied = copy.operator()<std::uint32_t>(); break;
        case kGltfFloat: is_copied = copy.operator()<float>(); break;
        default: break;
    }
    if (!is_copied) document.fail(label + " does not fit the componentType of its accessor");
    return bytes;
}

/// Decodes a mesh of this number of vertices. Returns why it cannot be decoded; empty if it was.
template <class Decoder>
std::string decode(std::string_view encoded, std::size_t vertices, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(encoded.data(), encoded.size());
    BoundedDecoder<Decoder> decoder(vertices);
    if (decoder.Decode(draco::DecoderOptions(), &buffer, &mesh).ok()) return "";
    return decoder.refusal().empty() ? "is not valid" : "needs " + decoder.refusal();
}

std::string text_of(std::uint64_t vertices, std::uint64_t triangles) {
    return std::to_string(vertices) + " vertices and " + std::to_string(triangles) + " triangles";
}

}  // namespace

DracoMesh decode_draco(const GltfDocument& document, std::string_view encoded, const DracoSize& size,
                       const std::vector<DracoAttribute>& attributes, const std::string& where) {
    if (size.vertices > kMaxDracoElements || size.triangles > kMaxDracoElements)
        document.fail(where + ": has " + text_of(size.vertices, size.triangles) + "; at most " +
                      std::to_string(kMaxDracoElements) + " of each are decoded by Draco");
    const DracoHeader header = read_header(document, encoded, where);
    const auto check_size = [&](std::uint64_t vertices, std::uint64_t triangles, bool is_equal) {
        if (is_equal ? vertices == size.vertices && triangles == size.triangles
                     : vertices <= size.vertices && triangles == size.triangles)
            return;
        document.fail(where + ": its Draco mesh has " + text_of(vertices, triangles) + "; its accessors have " +
                      text_of(size.vertices, size.triangles));
    };
    // Edgebreaker's vertices at the seams of attributes become several vertices.
    check_size(header.vertices, header.triangles, !header.is_edgebreaker);
    constexpr std::size_t kBytesPerTriangle = 100;  // of the connectivity
    if (const std::string why = too_much_memory(kBytesPerTriangle * size.triangles); !why.empty())
        document.fail(where + ": its Draco mesh needs " + why);
    draco::Mesh mesh;
    const std::string why = header.is_edgebreaker ? decode<draco::MeshEdgebreakerDecoder>(encoded, size.vertices, mesh)
                                                  : decode<draco::MeshSequentialDecoder>(encoded, size.vertices, mesh);
    if (!why.empty()) document.fail(where + ": its Draco mesh " + why);
    check_size(mesh.num_points(), mesh.num_faces(), true);
    DracoMesh out;
    out.indices.reserve(3 * size.triangles);
    for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
        for (const draco::PointIndex& vertex : mesh.face(draco::FaceIndex(i))) out.indices.push_back(vertex.value());
    for (const DracoAttribute& request : attributes)
        out.attributes.push_back(elements_of(document, mesh, request, where));
    return out;
}

#else

DracoMesh decode_draco(const GltfDocument& document, std::string_view, const DracoSize&,
                       const std::vector<DracoAttribute>&, const std::string& where) {
    document.fail(where + ": its triangles are " + compression_error(kDraco));
}

#endif

}  // namespace realcam::io
