#pragma once
#include "film_region.hpp"

namespace REALCAM_NAMESPACE {

/// In which pixels besides its own a sample may count (dispersed_rays.hpp): those of its tile of a part of the film.
/// Threads take tiles as a whole, so all these pixels have equally many samples.
struct SampleSharing {
    static constexpr int kTileSide = 32;

    FilmRegion part;  ///< empty: in no other
    int stride = 0;   ///< from a pixel to the one below, in the sums to which samples are added

    /// Whether two pixels of the film lie in the same tile. The first one lies in the part.
    REALCAM_INLINE bool has_both(int column, int row, int other_column, int other_row) const {
        const int right = other_column - part.column, down = other_row - part.row;
        const bool is_inside = (right >= 0) & (right < part.width) & (down >= 0) & (down < part.height);
        return is_inside & (right / kTileSide == (column - part.column) / kTileSide) &
               (down / kTileSide == (row - part.row) / kTileSide);
    }
};

}  // namespace REALCAM_NAMESPACE
