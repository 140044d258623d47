#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "../../math/quaternion.hpp"

namespace realcam::io {

/// How a file's keys are to be interpolated (glTF 2.0, appendix C).
enum class KeyInterpolation { linear, step, cubic_spline };

/// Numbers that change with time: three or four for each time, of cubic splines nine or twelve (the tangent before, the
/// value, the tangent behind).
struct FileKeys {
    std::vector<double> times;  ///< rising, at least one
    std::vector<float> values;
    KeyInterpolation interpolation = KeyInterpolation::linear;
    std::size_t components = 3;
};

/// How a node moves in the frame of its parent: shift, turn and scale, each by keys, or as it stands.
struct FileMotion {
    Vec3d translation = {0, 0, 0}, scale = {1, 1, 1};
    Quaternion rotation;
    std::shared_ptr<const FileKeys> translation_keys, rotation_keys, scale_keys;  ///< null: it does not change

    Affine<double> parent_from_node(double time) const;
    /// Those of all keys, in no order; of what jumps, also just before it does.
    std::vector<double> times() const;
};

}  // namespace realcam::io
