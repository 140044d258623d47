#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The medium in front of a surface, on the light's way to the film.
const Glass& medium_before(const LensSystem& lens, std::size_t index);

/// Whether a refracting surface has air on one side and something else on the other: the faces that are coated.
/// Two glasses that touch are cemented, and so bare unless the lens says otherwise.
bool is_face_in_air(const LensSystem& lens, std::size_t index);

/// The surfaces, counted from 0, of which the lens does not say how they are coated: glass in air, taken for bare, and
/// mirrors, taken for perfect ones.
std::vector<int> surfaces_with_unknown_coating(const LensSystem& lens);

/// What covers each face in air, each mirror and whatever else the lens says something of, with the numbers of the
/// surfaces from 1: "bare: 1, 2; unknown, taken as bare: 5".
std::string coating_summary(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
