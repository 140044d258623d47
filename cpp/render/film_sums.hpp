#pragma once
#include <cstdint>
#include <vector>

#include "../optics/trace/ray_loop.hpp"
#include "film_view.hpp"
#include "image.hpp"

namespace REALCAM_NAMESPACE {

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

}  // namespace REALCAM_NAMESPACE
