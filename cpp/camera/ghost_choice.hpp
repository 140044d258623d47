#pragma once
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Which ghosts a picture has.
struct GhostChoice {
    bool of_lens = true;  ///< of pairs of the lens's surfaces
    double film_reflectance = 0;  ///< more than 0: of pairs of the film, which reflects so much, and a surface
    /// Those that bring less of the light that the lens itself brings to the film, from all sides alike, are left out.
    double least_share = 0;

    bool operator==(const GhostChoice&) const = default;
};

}  // namespace REALCAM_NAMESPACE
