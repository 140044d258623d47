#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Storage of an aperture's diffraction pattern. Low frequencies are in cells: rings divided into sectors over half a
// turn (the pattern is symmetric). Higher frequencies are represented by the aperture's edges. Frequencies are in
// periods over the width of the aperture.

inline constexpr int kDiffractionAzimuths = 48;
inline constexpr int kDiffractionFineRings = 144;
inline constexpr float kDiffractionFineStep = 1.0f / 24, kDiffractionReach = 6;
/// Beyond these rings, three are merged into one: the dark rings near the centre are narrower than the bright ones
/// further out.
inline constexpr int kDiffractionThinRings = 60, kDiffractionThickness = 3;
inline constexpr int kDiffractionRings =
    kDiffractionThinRings + (kDiffractionFineRings - kDiffractionThinRings) / kDiffractionThickness;
inline constexpr int kDiffractionCells = kDiffractionRings * kDiffractionAzimuths;

constexpr int cell_of_fine_ring(int ring) {
    return ring < kDiffractionThinRings
               ? ring
               : kDiffractionThinRings + (ring - kDiffractionThinRings) / kDiffractionThickness;
}

/// A piece of the aperture's edge.
struct DiffractionEdge {
    float angle, turn;  ///< azimuth of the normal at the start of the piece, and its rotation along it; turns
    float spread;       ///< 1 / length of the smooth edge that contains the piece, in widths of the aperture
};

}  // namespace REALCAM_NAMESPACE
