#pragma once
#include <algorithm>

#include "pixel_sum.hpp"
#include "render_settings.hpp"

namespace REALCAM_NAMESPACE {

// A sample with a wavelength counts for more than one in some channels of the film and for less in others, and samples
// of neighbours count, too (dispersed_rays.hpp). So a pixel has, by chance, more of one colour than the next, even
// where all is white. How much is known: PixelSum::besides holds what the samples would bring if all that they see were
// white, less the number of those that pass. In the mean of the pixels around, this is what the lens does, because rims
// pass more of one colour than of another. What a pixel has beyond that is chance, and its light is taken for as much
// too large: a control variate, whose factor is the light itself (Owen, Monte Carlo theory, methods and examples, 2013,
// section 8.9).

/// Whether PixelSum::besides holds these sums: where samples have wavelengths, and no layer needs the place.
inline bool balances_wavelengths(const RenderSettings& settings) {
    return settings.effects.have_wavelengths() && !settings.layers.has(Layer::variance) &&
           !settings.layers.has_any(kHalfLayers);
}

/// By what the mean of a pixel's samples is multiplied in a channel.
///
/// With d, the excess by chance, the light of an evenly white scene is 1 + d. 1 / (1 + d) would be too small in the
/// mean, by as much as d varies, where not all of d is taken out. 1 - s d (1 - d) is right to the second order for any
/// share s. Few samples are by chance so much too coloured that less is taken out of them.
REALCAM_HD inline double wavelength_balance(const PixelSum& pixel, int channel, double mean_excess) {
    constexpr double kFew = 4, kMost = 0.5;
    if (pixel.samples == 0) return 1;
    const double n = static_cast<double>(pixel.samples);
    const double d = std::clamp(pixel.besides[channel] / n - mean_excess, -kMost, kMost);
    return 1 - n / (n + kFew) * d * (1 - d);
}

/// The excess of some pixels, in the three channels, and their samples.
struct ExcessSum {
    static constexpr int kReach = 2;  ///< pixels around one, to all sides

    double excess[3] = {0, 0, 0}, samples = 0;

    /// The pixels around a place in one column of a film, which is stored row by row; none outside of it.
    REALCAM_HD static ExcessSum of_column(const PixelSum* film, int width, int height, int column, int row) {
        ExcessSum sum;
        if (column < 0 || column >= width) return sum;
        const int end = std::min(row + kReach + 1, height);
        for (int y = std::max(row - kReach, 0); y < end; ++y) {
            const PixelSum& pixel = film[static_cast<std::int64_t>(y) * width + column];
            for (int c = 0; c < 3; ++c) sum.excess[c] += pixel.besides[c];
            sum.samples += static_cast<double>(pixel.samples);
        }
        return sum;
    }
    /// The same of all columns around a place: of_column(column) gives them.
    template <class OfColumn>
    REALCAM_HD static ExcessSum around(int column, OfColumn&& of_column) {
        ExcessSum sum;
        for (int x = column - kReach; x <= column + kReach; ++x) {
            const ExcessSum& one = of_column(x);
            for (int c = 0; c < 3; ++c) sum.excess[c] += one.excess[c];
            sum.samples += one.samples;
        }
        return sum;
    }
    /// Of a sample.
    REALCAM_HD double mean(int channel) const { return samples > 0 ? excess[channel] / samples : 0; }
};

}  // namespace REALCAM_NAMESPACE
