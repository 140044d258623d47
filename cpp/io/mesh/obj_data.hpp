#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// Statements of an OBJ file, with its references resolved to indices from 0 that are in range.
struct ObjData {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<Vec3d> positions;
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> normals;
    std::vector<VertexColor> colours;  ///< per position, as encoded in the file; may be empty
    bool has_smoothing = false;        ///< true if any line defines smoothing groups

    // Indices for the corners of all faces, one after the other. Those of uvs and normals are empty if no face has any.
    std::vector<std::uint32_t> corner_positions, corner_uvs, corner_normals;
    std::vector<std::uint32_t> face_ends;  ///< index of the corner after each face's last

    /// Faces from `first_face` to before the next run's.
    struct Run {
        std::uint32_t first_face, material, group;
        std::uint32_t smoothing;  ///< smoothing group; 0: off, as before the first line "s"

        bool continues(const Run& before) const {
            return material == before.material && group == before.group && smoothing == before.smoothing;
        }
    };
    std::vector<Run> runs;
    std::vector<std::string> materials;  ///< names after "usemtl"
    std::vector<std::string> groups;  ///< names after "o" and "g"; the first is empty
    std::vector<std::string> libraries;  ///< texts after "mtllib"
    std::size_t short_faces = 0;  ///< faces left out, with fewer than three corners
};

/// Reads the statements of an OBJ file. `scale`: metres per unit, for the limit on coordinates. Throws FileError, and
/// SceneFileError with the line.
ObjData read_obj_data(const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
