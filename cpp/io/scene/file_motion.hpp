#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "../../math/interpolate_affine.hpp"

namespace realcam::io {

/// Interpolation of a file's keys (glTF 2.0, appendix C).
enum class KeyInterpolation { linear, step, cubic_spline };

/// Keyframes of a vector: three or four numbers for each time, or with cubic splines nine or twelve (in-tangent, value,
/// out-tangent).
struct FileKeys {
    std::vector<double> times;  ///< in seconds, strictly increasing; at least one
    std::vector<float> values;  ///< one vector after the other
    KeyInterpolation interpolation = KeyInterpolation::linear;
    std::size_t components = 3;  ///< numbers of a vector: 3, or 4 for a quaternion x, y, z, w
};

/// Motion of a node in the frame of its parent: translation, rotation and scale, each animated by keys or constant.
struct FileMotion {
    Vec3d translation = {0, 0, 0}, scale = {1, 1, 1};
    Quaternion rotation;
    std::shared_ptr<const FileKeys> translation_keys, rotation_keys, scale_keys;  ///< null if constant

    /// Returns the node's transform at a time in seconds. Before the first key and after the last, values are constant.
    Affine<double> parent_from_node(double time) const;
    /// Returns the times of all keys, unsorted; for steps, also the time just before each jump.
    std::vector<double> times() const;
};

}  // namespace realcam::io
