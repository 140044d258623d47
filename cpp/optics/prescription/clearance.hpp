#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Two faces of a lens that could not be made: light meets the second one in front of the first.
struct FaceCrossing {
    int first, second;  ///< surfaces, from 0
    double radius;      ///< from the axis, mm
    double depth;       ///< by how much they cross there, mm
};

/// Pairs of refracting or reflecting faces that cross inside their clear apertures, whether or not they are neighbours.
/// The two faces of an element must not cross anywhere up to the larger of its two rims, because the smaller face is
/// edged flat unless it is hollow. Stops and apertures are planes of no substance, and may cross a face: a stop may be
/// given at the vertex of one. Faces of revolution are compared with those that share their axis: not across a tilt or
/// a decentre. In the order of the light, and no more than `most`.
std::vector<FaceCrossing> find_crossings(const LensSystem& lens,
                                         std::size_t most = std::numeric_limits<std::size_t>::max());

/// The first of them.
std::optional<FaceCrossing> find_crossing(const LensSystem& lens);

/// Of a centred lens: whether the film lies in front of the rim of the last face, as far as its corners reach.
bool film_crosses_lens(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
