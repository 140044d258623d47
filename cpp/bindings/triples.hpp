#pragma once
#include <array>
#include <tuple>

#include "../math/color.hpp"
#include "../math/vec3.hpp"

namespace realcam::bindings {

/// Point or colour as passed from Python.
using Triple = std::array<double, 3>;
using Colour = std::array<float, 3>;

inline Vec3d vector_of(const Triple& v) {
    return {v[0], v[1], v[2]};
}

inline std::tuple<double, double, double> triple(Vec3d v) {
    return {v.x, v.y, v.z};
}

inline Color rgb(const Colour& c) {
    return {c[0], c[1], c[2]};
}

}  // namespace realcam::bindings
