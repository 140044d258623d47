#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../optics/trace/ray_loop.hpp"
#include "../ghosts/ghost_film.hpp"
#include "../layers/layer_sum.hpp"
#include "film_control_variates.hpp"
#include "image.hpp"

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

/// Accumulated samples of a film in host memory, row by row.
using FilmSums = std::vector<PixelSum>;

/// Develops exposure and depth of a film; the cost of the picture is not filled in. `loop`: runs over its pixels.
Image developed(const FilmView& film, double exposure_time_s, const RayLoop& loop = {});

/// Develops a film as 8-bit sRGB, 3 per pixel. `loop`: runs over its pixels.
std::vector<std::uint8_t> developed_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                                          const RayLoop& loop = {});

/// Exposure by the light that was traced from the lights, 3 per pixel.
LayerImage developed_traced(const FilmView& film, double exposure_time_s);

/// Variance of the exposure, 3 per pixel (PixelSum::variance).
LayerImage developed_variance(const FilmView& film, double exposure_time_s);

/// The requested layers among the variance, the traced light and the halves of dual pixels.
std::vector<LayerImage> developed_auxiliary_layers(const FilmView& film, LayerSet wanted, double exposure_time_s);

/// Number of samples of each pixel.
std::vector<std::int64_t> samples_of(const FilmSums& film);

/// One kind of a picture's light that was traced apart from the samples of its pixels, in host memory.
struct SplatFilm {
    GhostLight light = GhostLight::of_lights;
    std::vector<GhostSum> sums;  ///< values for all pixels, film by film (GhostFilmView)
    std::vector<unsigned long long> blocks;  ///< number of sample blocks in each film
    double units_per_lux = 1;
    int width = 0, height = 0;  ///< pixels

    /// Films without light; `films`: their number.
    static SplatFilm empty(GhostLight light, int width, int height, int films, double units_per_lux) {
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                          count = static_cast<std::size_t>(films);
        return {
            light, std::vector<GhostSum>(count * pixels), std::vector<unsigned long long>(count), units_per_lux, width,
            height};
    }

    GhostFilmView view() const {
        return {light,
                sums.empty() ? nullptr : sums.data(),
                static_cast<int>(blocks.size()),
                units_per_lux,
                blocks.data(),
                width,
                height};
    }
};

/// View of at most kMostSplats films, which must outlive it.
SplattedLight view_of(const std::vector<SplatFilm>& films);

/// View of a film in host memory for its development. The pixels' sums and the splats must outlive it.
FilmView view_of(const FilmSums& pixels, int width, int height, const RenderSettings& settings,
                 const std::vector<SplatFilm>& splats);

/// Exposure by the traced light, 3 per pixel, lux seconds. Empty if the films have no pixels.
std::vector<float> traced_exposure(const std::vector<SplatFilm>& films, double exposure_time_s);

/// Accumulated samples of the pixels of a region.
struct RegionSums {
    FilmSums pixels;
    RenderStats stats;
};

/// Accumulated samples of a whole film, merged from all its parts, wherever they were exposed.
struct AccumulatedFilm {
    FilmSums pixels;
    std::vector<LayerSum> layers;  ///< one for each pixel; empty if no requested layer needs them
    std::vector<SplatFilm> splats;
    RenderStats stats;
};

}  // namespace REALCAM_NAMESPACE
