#pragma once
#include <cstdint>
#include <vector>

#include "../optics/trace/ray_loop.hpp"
#include "ghost_film.hpp"
#include "image.hpp"
#include "pixel_sum.hpp"

namespace REALCAM_NAMESPACE {

/// A film in the host's memory while it is exposed, row by row.
using FilmSums = std::vector<PixelSum>;

struct FilmSize {
    int width, height;  ///< pixels
};

/// Exposure and depth of a film, without what the picture cost. `balances`: the film holds what wavelength_balance.hpp
/// needs. `loop`: over its pixels.
Image developed(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                const SplattedLight& splatted = {}, const RayLoop& loop = {});

/// A film as 8-bit sRGB, 3 per pixel. `balances`, `loop`: likewise.
std::vector<std::uint8_t> developed_codes(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                                          double iso, ToneCurve curve, const SplattedLight& splatted = {},
                                          const RayLoop& loop = {});

/// Variance of the exposure, 3 per pixel (PixelSum::variance).
LayerImage developed_variance(const FilmSums& film, double exposure_time_s, const SplattedLight& splatted = {});

/// The layers of PixelSum::besides that are wanted: the variance, or the halves of dual pixels.
std::vector<LayerImage> developed_besides(const FilmSums& film, LayerSet wanted, double exposure_time_s,
                                          const SplattedLight& splatted = {});

/// How many samples each pixel has.
std::vector<std::int64_t> samples_of(const FilmSums& film);

}  // namespace REALCAM_NAMESPACE
