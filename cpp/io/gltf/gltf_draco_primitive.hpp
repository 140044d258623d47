#pragma once
#include <string>
#include <vector>

#include "gltf_accessors.hpp"
#include "gltf_buffers.hpp"

namespace realcam::io {

/// Mode of primitives that are triangles.
inline constexpr std::size_t kGltfTriangles = 4;

/// Decodes a primitive of KHR_draco_mesh_compression: returns the elements of its accessors, or an empty map for
/// another primitive. `primitive`: its JSON; `names`: the attributes that are read. Without the library, an
/// uncompressed form is used. Throws SceneFileError, whose message begins with `label`, also if there is no such form.
DecodedAccessors decode_primitive(const GltfDocument& document, GltfBuffers& buffers, const Json& primitive,
                                  const std::vector<std::string>& names, const std::string& label);

}  // namespace realcam::io
