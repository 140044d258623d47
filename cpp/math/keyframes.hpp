#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "interpolate_affine.hpp"

// Keyframes as scene files have them (glTF 2.0, appendix C): of vectors, and of the transforms of nodes.

namespace REALCAM_NAMESPACE {

/// Interpolation between the keyframes of a vector.
enum class KeyInterpolation { linear, step, cubic_spline };

/// Keyframes of a vector: `components` numbers for each time, or with cubic splines three times as many (in-tangent,
/// value, out-tangent).
struct VectorKeys {
    std::vector<double> times;  ///< in seconds, strictly increasing; at least one
    std::vector<float> values;  ///< one vector after the other
    KeyInterpolation interpolation = KeyInterpolation::linear;
    std::size_t components = 3;  ///< numbers of a vector; 4 for a quaternion x, y, z, w

    /// Writes the vector at a time in seconds to `out`, which has `components` elements. Before the first key and after
    /// the last, values are constant.
    void at(double time, double* out) const;
    /// True if the vector is not constant.
    bool changes() const;
};

/// Returns why keyframes are invalid; empty if they are valid and have vectors of this number of components.
std::string keys_error(const VectorKeys& keys, std::size_t components);

/// Motion of a node in the frame of its parent: translation, rotation and scale, each animated by keys or constant.
struct NodeMotion {
    Vec3d translation = {0, 0, 0}, scale = {1, 1, 1};
    Quaternion rotation;
    std::shared_ptr<const VectorKeys> translation_keys, rotation_keys, scale_keys;  ///< null if constant

    /// Returns the node's transform at a time in seconds. Before the first key and after the last, values are constant.
    Affine<double> parent_from_node(double time) const;
    /// Returns the times of all keys, unsorted; for steps, also the time just before each jump.
    std::vector<double> times() const;
};

}  // namespace REALCAM_NAMESPACE
