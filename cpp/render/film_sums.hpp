#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../camera/code_table.hpp"
#include "ghost_film.hpp"
#include "image.hpp"
#include "pixel_sum.hpp"

namespace REALCAM_NAMESPACE {

/// A film in the host's memory while it is exposed, row by row.
using FilmSums = std::vector<PixelSum>;

/// Exposure and depth of a film, without what the picture cost.
Image developed(const FilmSums& film, int width, int height, double exposure_time_s,
                const SplattedLight& splatted = {});

/// Pixels first to last - 1 as 8-bit sRGB, into `codes` of the film, 3 per pixel.
void develop_codes(const FilmSums& film, std::size_t first, std::size_t last, double exposure_time_s,
                   const CodeTable& code_of, const SplattedLight& splatted, std::span<std::uint8_t> codes);

/// Variance of the exposure, 3 per pixel (PixelSum::variance).
LayerImage developed_variance(const FilmSums& film, double exposure_time_s, const SplattedLight& splatted = {});

/// The layers of PixelSum::besides that are wanted: the variance, or the halves of dual pixels.
std::vector<LayerImage> developed_besides(const FilmSums& film, LayerSet wanted, double exposure_time_s,
                                          const SplattedLight& splatted = {});

/// How many samples each pixel has.
std::vector<std::int64_t> samples_of(const FilmSums& film);

}  // namespace REALCAM_NAMESPACE
