#pragma once
// Validation of scenes from any source.

#include <cmath>
#include <cstddef>
#include <string>

#include "../checkpoint.hpp"
#include "../error.hpp"
#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

/// True if all coordinates are finite.
inline bool is_finite(Vec3d p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
/// True if all coordinates, in metres, are finite and at most 1e12 m, so that the point can be rendered.
bool in_reach(Vec3d p_m);

/// Returns the error text for coordinates, in the file's units, for which in_reach is false.
std::string coordinates_error(Vec3d p);

/// Checks everything that a renderer relies on: list sizes, indices, finite numbers, no negative light or reflectance.
/// Throws SceneFileError if there is no triangle or if `file`, for the message, is not empty, and InputError otherwise;
/// the message names the element, counted from 0. `may_be_empty`: accepts geometry without triangles, such as an object
/// of point lights or the static geometry of a scene of instances. Throws Cancelled if `checkpoint` does.
void validate(const Scene& scene, const std::string& file, bool may_be_empty, Checkpoint& checkpoint);
/// The same without a way to stop it.
void validate(const Scene& scene, const std::string& file = {}, bool may_be_empty = false);

/// Throws InputError if a texture has the wrong number of texels, or texels that are negative or not finite.
void validate(const Texture& texture);

/// Throws InputError if a property of the air is out of range.
void validate(const Air& air);

/// Incremental validation of successive scenes: static geometry, objects and transforms, skipping all parts of the
/// previous scene, which it keeps in memory.
class SceneChecks {
public:
    /// Throws like validate(Scene), InputError for an invalid instance or camera, and Cancelled if `keep_going` returns
    /// false.
    void check(const Assembly& scene, const std::string& file = {}, const KeepGoing& keep_going = {});

private:
    /// Checks the static geometry and the objects, except for those of the previous scene.
    void check_parts(const Assembly& scene, const std::string& file, Checkpoint& checkpoint) const;

    Assembly last_;  ///< the previous valid scene
};

/// True for a triangle in metres with an area below (1 nm)^2 or a height below 1e-12 of its longest edge. Its indices
/// must be in range.
bool is_degenerate(const Scene& scene, const Triangle& triangle);

/// Removes degenerate triangles and returns their number.
inline std::size_t drop_degenerate_triangles(Scene& scene) {
    return std::erase_if(scene.triangles, [&](const Triangle& t) { return is_degenerate(scene, t); });
}

}  // namespace REALCAM_NAMESPACE
