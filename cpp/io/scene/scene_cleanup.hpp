#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

/// Special values of Smoothing::groups, beside the numbers of smoothing groups: no vertex normals, or smooth up to an
/// angle of 45 degrees between faces.
inline constexpr std::uint32_t kFlat = 0, kSmoothByAngle = 0xffffffffu;

/// Assigns triangles to smoothing groups.
struct Smoothing {
    /// One per triangle: kFlat, kSmoothByAngle, or the number of its smoothing group.
    std::vector<std::uint32_t> groups;
    /// Index of each vertex's position in the file. Faces of a group are smooth across vertices with the same index; if
    /// this list is empty, across vertices with equal positions.
    std::vector<std::uint32_t> position_ids;
};

/// Computes normals for triangles that are not flat: at a corner, the mean of the faces that meet there, weighted by
/// their angle there (Thuermer and Wuethrich 1998). In a smoothing group these are the faces of the group; by angle,
/// those within 45 degrees of the triangle's plane, so that sharper edges, such as a cube's, stay edges. Vertices are
/// added if a position needs several normals. The triangles must not be degenerate.
void smooth_normals(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint);

/// Last step of every reader: drops degenerate triangles, with a warning, smooths the others, and merges equal
/// vertices. Indices must be in range. Throws SceneFileError, with `path`, if no triangle remains.
void clean_geometry(Scene& scene, Smoothing smoothing, const std::string& path, Checkpoint& checkpoint);

/// Adds the warning "path: count problem" unless `count` is 0.
void warn_count(Scene& scene, const std::string& path, std::size_t count, const std::string& problem);

}  // namespace realcam::io
