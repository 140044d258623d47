#pragma once
// Whether a scene makes sense, whoever built it. Here and not beside Scene, because the core throws nothing.

#include <cstddef>
#include <string>

#include "../scene/assembly.hpp"

namespace realcam::io {

/// Checks everything that a renderer relies on: sizes of lists, indices, finite numbers, no negative light or
/// reflectance. Throws SceneFileError if there is no triangle or if `file`, for the message, is given, and InputError
/// otherwise; the message names the element, counted from 0. `may_be_empty`: of what has no triangle but emitters, or
/// of a scene that consists of instances.
void validate(const Scene& scene, const std::string& file = {}, bool may_be_empty = false);

/// The same of static geometry, of the objects, and of their transforms.
void validate(const Assembly& scene, const std::string& file = {});

/// Whether coordinates in metres are finite, and near enough to be rendered.
bool is_finite(Vec3d position);
bool in_reach(Vec3d position_m);
/// What messages say of coordinates, as the file gives them, that are not in reach.
std::string why_out_of_reach(Vec3d position);

/// No area to speak of: less than (1 nm)^2, or thinner than 1e-12 of its length. Its indices have to be in range.
bool is_degenerate(const Scene& scene, const Triangle& triangle);

/// Returns how many triangles it dropped.
std::size_t drop_degenerate_triangles(Scene& scene);

}  // namespace realcam::io
