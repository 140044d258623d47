#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Overlap of two faces: light meets the second one in front of the first, so that the lens cannot be made.
struct FaceOverlap {
    int first, second;  ///< surfaces, from 0
    double radius;  ///< distance from the axis, mm
    double depth;  ///< overlap there along the axis, mm
};

/// Returns the pairs of refracting or reflecting faces that overlap inside their clear apertures, whether or not they
/// are neighbours, in the order of the light, and at most `most` of them.
///
/// The two faces of an element must not overlap anywhere up to the larger of its two rims, because the smaller face is
/// edged flat unless it is concave. Stops and apertures are planes without thickness and may cross a face: a stop may
/// be specified at the vertex of one. Faces of revolution are compared only with those on the same axis, not across a
/// tilt or a decentre.
std::vector<FaceOverlap> find_overlaps(const LensSystem& lens,
                                       std::size_t most = std::numeric_limits<std::size_t>::max());

/// Returns the first overlap of find_overlaps; std::nullopt if no faces overlap.
std::optional<FaceOverlap> find_overlap(const LensSystem& lens);

/// True if the film of a centred lens cuts through the last face, up to the smaller of the face's rim and the film's
/// half diagonal. Always false for lenses without rotational symmetry.
bool film_crosses_lens(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
