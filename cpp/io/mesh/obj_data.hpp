#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"
#include "../../scene/scene_view.hpp"

namespace realcam::io {

/// Content of an OBJ file, with its references resolved to indices from 0 that are in range.
struct ObjData {
    static constexpr std::uint32_t kNone = 0xffffffffu;  ///< index of an absent element

    std::vector<Vec3d> positions;  ///< in units of the file
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> normals;
    std::vector<VertexColor> colours;  ///< per position, as encoded in the file; may be empty
    bool has_smoothing = false;        ///< true if any line defines smoothing groups

    // Indices in the lists above for the corners of all faces, one after the other; kNone for a corner without. The
    // lists for uvs and normals are empty if no face has any.
    std::vector<std::uint32_t> corner_positions, corner_uvs, corner_normals;
    std::vector<std::uint32_t> face_ends;  ///< index behind each face's last corner

    /// Consecutive faces with the same material, group and smoothing group: from `first_face` to the next run's.
    struct Run {
        std::uint32_t first_face;
        std::uint32_t material;  ///< index in materials, or kNone
        std::uint32_t group;  ///< index in groups
        std::uint32_t smoothing;  ///< smoothing group; 0: off, as before the first line "s"

        bool continues(const Run& previous) const {
            return material == previous.material && group == previous.group && smoothing == previous.smoothing;
        }
    };
    std::vector<Run> runs;
    std::vector<std::string> materials;  ///< names after "usemtl"
    std::vector<std::string> groups;  ///< names after "o" and "g"; the first is empty
    std::vector<std::string> libraries;  ///< texts after "mtllib"
    std::size_t short_faces = 0;  ///< faces left out, with fewer than three corners
};

/// Reads an OBJ file. `scale`: metres per unit, for the limit on coordinates (in_reach). Throws FileError, and
/// SceneFileError with the line.
ObjData read_obj_data(const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
