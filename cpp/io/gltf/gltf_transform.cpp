#include "gltf_transform.hpp"

namespace realcam::io {
namespace {

Vec3d vector_of(const Json& numbers, Vec3d otherwise) {
    return {numbers[std::size_t{0}].number(otherwise.x), numbers[1].number(otherwise.y),
            numbers[2].number(otherwise.z)};
}

Affine<double> matrix_of(const Json& m) {  // column-major
    const auto column = [&](std::size_t c) {
        return Vec3d{m[4 * c].number(0), m[4 * c + 1].number(0), m[4 * c + 2].number(0)};
    };
    return {column(0), column(1), column(2), column(3)};
}

}  // namespace

FileMotion standing(const Json& node) {
    FileMotion motion;
    const Json& q = node["rotation"];
    // Files round quaternions to seven digits; `rotation` accepts any length.
    const Quaternion turn = {vector_of(q, {0, 0, 0}), q[3].number(1)};
    if (dot(turn, turn) > 0) motion.rotation = turn;
    motion.scale = vector_of(node["scale"], {1, 1, 1});
    motion.translation = vector_of(node["translation"], {0, 0, 0});
    return motion;
}

Affine<double> transform_of(const Json& node) {
    if (node["matrix"].size() == 16) return matrix_of(node["matrix"]);
    return standing(node).parent_from_node(0);
}

}  // namespace realcam::io
