#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

// Layout of the stored diffraction pattern of an aperture. Low spatial frequencies are stored in polar cells: rings
// times azimuth sectors over half a turn (the pattern is symmetric). Higher frequencies are represented by the edges of
// the aperture. The unit of frequencies is one period over the width of the aperture.

inline constexpr int kDiffractionAzimuths = 48;  ///< sectors over half a turn
inline constexpr int kDiffractionFineRings = 144;  ///< rings at which the pattern is computed
inline constexpr float kDiffractionFineStep = 1.0f / 24;  ///< width of a fine ring
inline constexpr float kDiffractionMaxFrequency = 6;  ///< largest frequency of the cells: the fine rings end there
inline constexpr int kDiffractionUnmergedRings = 60;  ///< innermost fine rings, which are stored one by one
/// Number of fine rings that are merged into one stored ring further out, where details of the pattern are wider.
inline constexpr int kDiffractionMergedRings = 3;
/// Number of stored rings.
inline constexpr int kDiffractionRings =
    kDiffractionUnmergedRings + (kDiffractionFineRings - kDiffractionUnmergedRings) / kDiffractionMergedRings;
/// Number of cells: stored ring * kDiffractionAzimuths + azimuth is the index of a cell.
inline constexpr int kDiffractionCells = kDiffractionRings * kDiffractionAzimuths;

/// Returns the stored ring that contains a fine ring.
constexpr int stored_ring_of(int ring) {
    return ring < kDiffractionUnmergedRings
               ? ring
               : kDiffractionUnmergedRings + (ring - kDiffractionUnmergedRings) / kDiffractionMergedRings;
}

/// A segment of the aperture's edge.
struct DiffractionEdge {
    float angle;  ///< azimuth of the outward normal at the start of the segment, in turns
    float turn;  ///< rotation of the normal from the start to the end of the segment, in turns
    float spread;  ///< 1 / length of the smooth edge (from corner to corner) that contains the segment, in widths of
                   ///< the aperture
};

}  // namespace REALCAM_NAMESPACE
