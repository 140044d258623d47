#pragma once
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Selection of the ghosts of a picture.
struct GhostChoice {
    bool of_lens = true;  ///< ghosts of two lens surfaces
    double film_reflectance = 0;  ///< positive: ghosts of the film, with this reflectance, and a lens surface
    /// Ghosts with a smaller fraction of the lens's own light on the film, for a uniform surround, are left out.
    double least_share = 0;

    bool operator==(const GhostChoice&) const = default;
};

}  // namespace REALCAM_NAMESPACE
