#pragma once
// Compressed geometry: KHR_draco_mesh_compression by libdraco, and EXT_meshopt_compression (or KHR_meshopt_compression)
// by meshoptimizer. Both libraries are optional.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gltf_document.hpp"

namespace realcam::io {

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

/// Returns the name of the library that an extension needs and without which this program was built; otherwise empty.
std::string missing_library(std::string_view extension);

/// Returns the end of an error message about data in a compressed form whose library is missing.
std::string compression_error(const std::string& extension);

/// Decodes a bufferView. `extension`: JSON of its compression; `encoded`: the compressed bytes; `where`: beginning of
/// messages. Throws SceneFileError, also if the bytes are too few for the promised elements: the codecs shrink data by
/// at most 64 to 1.
std::string decode_meshopt(const GltfDocument& document, const Json& extension, std::string_view encoded,
                           const std::string& where);

/// Attribute of a Draco mesh as an accessor describes it.
struct DracoAttribute {
    std::size_t id;  ///< unique id in the Draco mesh
    std::size_t component_type;  ///< see GltfComponentType
    std::size_t components;  ///< of each element
};

/// Size of a Draco mesh according to the accessors of its primitive.
struct DracoSize {
    std::size_t vertices, triangles;
};

/// Decoded Draco mesh.
struct DracoMesh {
    std::vector<std::uint32_t> indices;  ///< three for each triangle
    std::vector<std::string> attributes;  ///< bytes of the elements of each requested attribute, without padding
};

/// Greatest number of vertices, and of triangles, of a Draco mesh, and of components of a vertex over all attributes.
inline constexpr std::size_t kMaxDracoElements = std::size_t{1} << 24, kMaxDracoComponents = 128;

/// Decodes a Draco mesh. `encoded`: its bytes, of Draco's bitstream 2.2; `size`: the number of vertices and triangles
/// that it must have. They are compared with the numbers in the mesh's header before memory is allocated for them.
/// Throws SceneFileError, whose message begins with `where`.
DracoMesh decode_draco(const GltfDocument& document, std::string_view encoded, const DracoSize& size,
                       const std::vector<DracoAttribute>& attributes, const std::string& where);

}  // namespace realcam::io
