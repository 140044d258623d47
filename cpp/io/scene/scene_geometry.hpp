#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Adds the punctual lights of the nodes of a part, with intensities in cd and illuminances in lux. Only glTF files
/// have lights. `leaves_out`: see LeftOutFunction.
void read_lights(Scene& scene, const ScenePart& part, const LeftOutFunction& leaves_out);

/// Vertex of a file.
struct VertexSource {
    std::uint32_t vertices, index;  ///< index in FileScene::vertices, and of the vertex in that list
};

/// Flattens the nodes of a part into scene.positions_m, normals, uvs and triangles. Material indices are those of the
/// file. Throws SceneFileError if no triangle remains, unless `leaves_out` excluded some, if a vertex is too far away,
/// or if there is too little memory. `sources`: receives the source of each vertex; equal vertices and degenerate
/// triangles are then kept.
void read_geometry(Scene& scene, const ScenePart& part, const LeftOutFunction& leaves_out,
                   std::vector<VertexSource>* sources = nullptr);

}  // namespace realcam::io
