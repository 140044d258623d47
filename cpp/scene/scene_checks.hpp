#pragma once
// Whether a scene makes sense, whoever built it.

#include <cmath>
#include <cstddef>
#include <string>

#include "../checkpoint.hpp"
#include "../error.hpp"
#include "assembly.hpp"

namespace REALCAM_NAMESPACE {

/// Whether coordinates in metres are finite, and near enough to be rendered.
inline bool is_finite(Vec3d p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
bool in_reach(Vec3d p_m);

/// What messages say of coordinates, as the file gives them, that are not in reach.
std::string why_out_of_reach(Vec3d p);

/// Checks everything that a renderer relies on: sizes of lists, indices, finite numbers, no negative light or
/// reflectance. Throws SceneFileError if there is no triangle or if `file`, for the message, is given, and InputError
/// otherwise; the message names the element, counted from 0. `may_be_empty`: of what has no triangle but emitters, or
/// of a scene that consists of instances. Throws Cancelled where `checkpoint` does.
void validate(const Scene& scene, const std::string& file, bool may_be_empty, Checkpoint& checkpoint);
void validate(const Scene& scene, const std::string& file = {}, bool may_be_empty = false);

/// Checks scenes that come one after the other: static geometry, objects and transforms, and of each scene only what
/// was no part of the last one. Keeps the last one in memory.
class SceneChecks {
public:
    /// Throws as validate(Scene), and InputError for what is wrong with an instance, and Cancelled.
    void check(const Assembly& scene, const std::string& file = {}, const KeepGoing& keep_going = {});

private:
    void check_parts(const Assembly& scene, const std::string& file, Checkpoint& checkpoint) const;

    Assembly last_;
};

/// No area to speak of: less than (1 nm)^2, or thinner than 1e-12 of its length. Its indices have to be in range.
bool is_degenerate(const Scene& scene, const Triangle& triangle);

/// Returns how many triangles it dropped.
inline std::size_t drop_degenerate_triangles(Scene& scene) {
    return std::erase_if(scene.triangles, [&](const Triangle& t) { return is_degenerate(scene, t); });
}

}  // namespace REALCAM_NAMESPACE
