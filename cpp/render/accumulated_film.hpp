#pragma once
#include <cstddef>
#include <vector>

#include "film_sums.hpp"
#include "ghost_film.hpp"
#include "image.hpp"
#include "layer_sum.hpp"

namespace REALCAM_NAMESPACE {

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
