#include "default_film.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace realcam {

Film default_film(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
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

}  // namespace realcam
