#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the medium in front of a surface, for light travelling to the film.
const Glass& medium_before(const LensSystem& lens, std::size_t index);

/// True if a refracting surface has air on exactly one side; lens makers coat these faces. Two glasses in contact are
/// cemented, and uncoated unless the lens specifies a coating.
bool is_face_in_air(const LensSystem& lens, std::size_t index);

/// Returns the surfaces, counted from 0, whose coating the lens does not specify: glass faces in air, assumed to be
/// bare, and mirrors, assumed to be perfect.
std::vector<int> surfaces_with_unknown_coating(const LensSystem& lens);

/// Lists the coatings of all faces in air, all mirrors and all other surfaces with a specified coating, with surface
/// numbers from 1: "bare: 1, 2; unknown, taken as bare: 5".
std::string coating_summary(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
