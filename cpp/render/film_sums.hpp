#pragma once
#include <cstdint>
#include <vector>

#include "../optics/trace/ray_loop.hpp"
#include "film_view.hpp"
#include "image.hpp"

namespace REALCAM_NAMESPACE {

/// A film in the host's memory while it is exposed, row by row.
using FilmSums = std::vector<PixelSum>;

/// Exposure and depth of a film, without what the picture cost. `loop`: over its pixels.
Image developed(const FilmView& film, double exposure_time_s, const RayLoop& loop = {});

/// A film as 8-bit sRGB, 3 per pixel. `loop`: likewise.
std::vector<std::uint8_t> developed_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                                          const RayLoop& loop = {});

/// Variance of the exposure, 3 per pixel (PixelSum::variance).
/// The exposure of the light that was traced from the lights.
LayerImage developed_traced(const FilmView& film, double exposure_time_s);

LayerImage developed_variance(const FilmView& film, double exposure_time_s);

/// The layers of PixelSum::besides that are wanted: the variance, or the halves of dual pixels.
std::vector<LayerImage> developed_besides(const FilmView& film, LayerSet wanted, double exposure_time_s);

/// How many samples each pixel has.
std::vector<std::int64_t> samples_of(const FilmSums& film);

}  // namespace REALCAM_NAMESPACE
