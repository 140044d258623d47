#pragma once
#include "film_region.hpp"

namespace REALCAM_NAMESPACE {

/// Pixels other than its own in which a sample may count (dispersed_rays.hpp): those of its tile in a part of the film.
/// Threads render whole tiles, so all these pixels have the same number of samples.
struct SampleSharing {
    static constexpr int kTileSide = 32;

    FilmRegion part;  ///< empty: samples count in their own pixel only
    int stride = 0;  ///< from a pixel to the one below, in the accumulated film

    /// True if two pixels of the film lie in the same tile. The first one must lie in `part`.
    REALCAM_INLINE bool has_both(int column, int row, int other_column, int other_row) const {
        const int right = other_column - part.column, down = other_row - part.row;
        const bool is_inside = (right >= 0) & (right < part.width) & (down >= 0) & (down < part.height);
        return is_inside & (right / kTileSide == (column - part.column) / kTileSide) &
               (down / kTileSide == (row - part.row) / kTileSide);
    }
};

}  // namespace REALCAM_NAMESPACE
