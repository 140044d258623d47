#include "ply_corners.hpp"

#include <cstdint>
#include <limits>
#include <utility>

#include "../../error.hpp"

namespace realcam::io {
namespace {

template <class T>
void take_corners(std::vector<T>& values, const std::vector<Triangle>& triangles, Checkpoint& checkpoint) {
    if (values.empty()) return;
    std::vector<T> out;
    out.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        checkpoint.pass();
        for (const std::uint32_t v : t.vertices) out.push_back(values[v]);
    }
    values = std::move(out);
}

}  // namespace

void apply_corners(Scene& scene, const PlyCorners& corners, Checkpoint& checkpoint) {
    if (corners.uvs.empty() && corners.colours.empty()) return;
    if (scene.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3)
        throw InputError("more than 1431655765 triangles");
    take_corners(scene.positions_m, scene.triangles, checkpoint);
    take_corners(scene.normals, scene.triangles, checkpoint);
    take_corners(scene.uvs, scene.triangles, checkpoint);
    take_corners(scene.colors, scene.triangles, checkpoint);
    if (!corners.uvs.empty()) scene.uvs = corners.uvs;
    if (!corners.colours.empty()) {
        scene.colors.clear();
        scene.colors.reserve(3 * corners.colours.size());
        for (const VertexColor& c : corners.colours) scene.colors.insert(scene.colors.end(), 3, c);
    }
    std::uint32_t corner = 0;
    for (Triangle& t : scene.triangles)
        for (std::uint32_t& v : t.vertices) v = corner++;
}

}  // namespace realcam::io
