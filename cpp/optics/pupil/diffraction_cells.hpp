#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// How the light that an aperture diffracts is stored. Near the middle there are cells of frequency: rings cut into
// sectors over half a turn (the other half is the same). Beyond, there are the aperture's edges. Frequencies are in
// periods over the width of the aperture.

inline constexpr int kDiffractionAzimuths = 48;
inline constexpr int kDiffractionFineRings = 144;
inline constexpr float kDiffractionFineStep = 1.0f / 24, kDiffractionReach = 6;
/// Beyond these rings, three are one: the dark rings near the middle are narrower than those further out are bright.
inline constexpr int kDiffractionThinRings = 60, kDiffractionThickness = 3;
inline constexpr int kDiffractionRings =
    kDiffractionThinRings + (kDiffractionFineRings - kDiffractionThinRings) / kDiffractionThickness;
inline constexpr int kDiffractionCells = kDiffractionRings * kDiffractionAzimuths;

constexpr int cell_of_fine_ring(int ring) {
    return ring < kDiffractionThinRings
               ? ring
               : kDiffractionThinRings + (ring - kDiffractionThinRings) / kDiffractionThickness;
}

/// A piece of an edge.
struct DiffractionEdge {
    float angle, turn;  ///< of the normal: where the piece begins, and by how much it turns along it; turns
    float spread;       ///< one over the length of the smooth edge of which it is a part, in widths
};

}  // namespace REALCAM_NAMESPACE
