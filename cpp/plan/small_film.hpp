#pragma once
#include <algorithm>

#include "../camera/camera.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the film with at most this many pixels along its longer side.
inline Film with_long_side(Film film, int pixels) {
    const double scale = std::min(1.0, static_cast<double>(pixels) / std::max(film.width, film.height));
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
    return film;
}

}  // namespace REALCAM_NAMESPACE
