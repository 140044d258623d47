#pragma once
#include "film_control_variates.hpp"
#include "ghost_film.hpp"

namespace REALCAM_NAMESPACE {

/// A film in the memory of the host or of a GPU, for its development.
struct FilmView {
    const PixelSum* pixels;  ///< row by row
    int width, height;
    FilmControlVariates balance = {};
    SplattedLight splatted = {};

    REALCAM_HD std::int64_t pixel_count() const { return std::int64_t{width} * height; }

    REALCAM_HD PixelNeighbourhood column_around(int column, int row) const {
        return PixelNeighbourhood::of_column(pixels, width, height, column, row, balance.wavelengths);
    }

    /// Calls take(channel, irradiance of the splatted light, balance) for a pixel, with the arguments of
    /// PixelSum::exposure. `around`: the pixel's neighbourhood; unused without control variates.
    template <class Take>
    REALCAM_HD void for_channels(std::int64_t pixel, const PixelNeighbourhood& around, Take&& take) const {
        const PixelSum& sum = pixels[pixel];
        const double passes = balance.passes ? pass_balance(sum, around) : 1;
        for (int c = 0; c < 3; ++c) {
            const bool is_coloured = balance.wavelengths && sum.samples > 0;
            take(c, splatted.irradiance(pixel, c), is_coloured ? passes * wavelength_balance(sum, c, around) : passes);
        }
    }
};

}  // namespace REALCAM_NAMESPACE
