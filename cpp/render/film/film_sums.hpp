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

/// A film in the memory of the host or of a GPU, for its development: the pixels' sums, and how they are corrected.
struct FilmView {
    const PixelSum* pixels;  ///< row by row
    int width, height;  ///< pixels
    FilmControlVariates control_variates = {};
    SplattedLight splatted = {};  ///< light that is added to that of the pixels' samples

    REALCAM_HD std::int64_t pixel_count() const { return std::int64_t{width} * height; }

    /// Returns the sums over the neighbourhood of a pixel in one column.
    REALCAM_HD PixelNeighbourhood column_around(int column, int row) const {
        return PixelNeighbourhood::of_column(pixels, width, height, column, row, control_variates.wavelengths);
    }

    /// Calls visit(channel, splatted irradiance in lux, factor of the control variates) for the channels of a pixel:
    /// the arguments of PixelSum::exposure. `around`: the pixel's neighbourhood; unused without control variates.
    template <class Visit>
    REALCAM_HD void for_channels(std::int64_t pixel, const PixelNeighbourhood& around, Visit&& visit) const {
        const PixelSum& sum = pixels[pixel];
        const double passes = control_variates.passes ? pass_balance(sum, around) : 1;
        for (int c = 0; c < 3; ++c) {
            const bool is_coloured = control_variates.wavelengths && sum.samples > 0;
            visit(c, splatted.irradiance(pixel, c), is_coloured ? passes * wavelength_balance(sum, c, around) : passes);
        }
    }
};

/// Accumulated samples of a film in host memory, row by row.
using FilmSums = std::vector<PixelSum>;

/// Develops a film to a picture with exposure and depth; its layers and cost are not set. `loop`: runs over the pixels,
/// on one thread or several.
Image developed(const FilmView& film, double exposure_time_s, const RayLoop& loop = {});

/// Develops a film to 8-bit sRGB values, 3 per pixel. `iso`, `curve`: see CodeTable. `loop`: runs over the pixels.
std::vector<std::uint8_t> developed_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                                          const RayLoop& loop = {});

/// Develops the layer traced_light: the exposure by splatted light, lux seconds, 3 per pixel.
LayerImage developed_traced(const FilmView& film, double exposure_time_s);

/// Develops the layer variance: the variance of the exposure, (lux seconds)^2, 3 per pixel (PixelSum::variance).
LayerImage developed_variance(const FilmView& film, double exposure_time_s);

/// Returns the requested layers among variance, traced_light and the dual-pixel halves.
std::vector<LayerImage> developed_auxiliary_layers(const FilmView& film, LayerSet requested, double exposure_time_s);

/// Returns the number of samples of each pixel.
std::vector<std::int64_t> samples_of(const FilmSums& film);

/// One kind of splatted light of a picture, in host memory.
struct SplatFilm {
    GhostLight light = GhostLight::of_lights;
    std::vector<GhostSum> sums;  ///< values for all pixels, film by film (GhostFilmView)
    std::vector<unsigned long long> blocks;  ///< number of sample blocks in each film
    double units_per_lux = 1;
    int width = 0, height = 0;  ///< pixels

    /// Returns `films` (1 or 2) films without light.
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

/// Returns a view of at most kMaxGhostViews kinds of splatted light, which must outlive it.
SplattedLight view_of(const std::vector<SplatFilm>& films);

/// Returns a view of a film in host memory for its development. `pixels` and `splats` must outlive it.
FilmView view_of(const FilmSums& pixels, int width, int height, const RenderSettings& settings,
                 const std::vector<SplatFilm>& splats);

/// Returns the exposure by splatted light, lux seconds, 3 per pixel. Empty if the films have no pixels.
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
