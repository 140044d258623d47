#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kDefaultLongSide = 960;

/// Completes what the user says of the film; pixels are square unless both size and resolution are given.
/// - Neither: the film of the lens, 960 pixels along its longer side.
/// - The size in mm alone: 960 pixels along its longer side.
/// - The resolution alone: the largest part of the lens's film that has its shape; upright pictures turn the film.
/// What makes no sense goes through unchanged, for validate(Camera) to name.
inline Film default_film(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
                         std::optional<std::array<int, 2>> resolution) {
    Film film;
    film.width_mm = size_mm ? (*size_mm)[0] : lens.film_width;
    film.height_mm = size_mm ? (*size_mm)[1] : lens.film_height;
    if (!resolution) {
        if (!(film.width_mm > 0) || !(film.height_mm > 0)) return film;
        const double pixels_per_mm = kDefaultLongSide / std::max(film.width_mm, film.height_mm);
        film.width = std::max(1, static_cast<int>(std::lround(film.width_mm * pixels_per_mm)));
        film.height = std::max(1, static_cast<int>(std::lround(film.height_mm * pixels_per_mm)));
        return film;
    }
    film.width = (*resolution)[0];
    film.height = (*resolution)[1];
    if (size_mm || film.width < 1 || film.height < 1) return film;
    if ((film.width < film.height) != (film.width_mm < film.height_mm)) std::swap(film.width_mm, film.height_mm);
    const double pitch = std::min(film.width_mm / film.width, film.height_mm / film.height);
    film.width_mm = pitch * film.width;
    film.height_mm = pitch * film.height;
    return film;
}

}  // namespace REALCAM_NAMESPACE
