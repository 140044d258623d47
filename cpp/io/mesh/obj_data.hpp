#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// The statements of an OBJ, with its references resolved to numbers from 0 that are in range.
struct ObjData {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<Vec3d> positions;
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> normals;
    std::vector<VertexColor> colours;  ///< of the positions, as the file has them; empty: none
    bool has_smoothing = false;        ///< whether any line says which faces are smooth

    // Indices of the corners of all faces, one after the other. Those of uvs and normals are empty where no face has
    // any.
    std::vector<std::uint32_t> corner_positions, corner_uvs, corner_normals;
    std::vector<std::uint32_t> face_ends;  ///< number of the corner after each face's last

    /// Faces from `first_face` up to the next run's.
    struct Run {
        std::uint32_t first_face, material, group;
        std::uint32_t smoothing;  ///< number of the smoothing group; 0: off, as before the first line "s"

        bool continues(const Run& before) const {
            return material == before.material && group == before.group && smoothing == before.smoothing;
        }
    };
    std::vector<Run> runs;
    std::vector<std::string> materials;  ///< names after "usemtl"
    std::vector<std::string> groups;  ///< names after "o" and "g"; the first is empty
    std::vector<std::string> libraries;  ///< texts after "mtllib"
    std::size_t short_faces = 0;  ///< left out, because they have fewer than three corners
};

/// `scale`: metres per unit, by which coordinates are found to be too large. Throws FileError, and SceneFileError with
/// the line.
ObjData read_obj_data(const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
