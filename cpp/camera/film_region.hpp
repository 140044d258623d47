#pragma once
#include <cstddef>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// A rectangle of the film, in pixels from the upper left corner of the picture.
struct FilmRegion {
    int column = 0, row = 0, width = 0, height = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }

    /// Row-major index in the region of a pixel of the film.
    std::size_t index(int film_column, int film_row) const {
        return static_cast<std::size_t>(film_row - row) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(film_column - column);
    }
};

}  // namespace REALCAM_NAMESPACE
