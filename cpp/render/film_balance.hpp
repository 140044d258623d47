#pragma once
#include <algorithm>

#include "pixel_sum.hpp"
#include "render_settings.hpp"

namespace REALCAM_NAMESPACE {

// Some noise of a pixel is not in the scene. By chance, more of its samples come through the lens than of the next
// pixel's. A sample with a wavelength counts for more than one in some channels of the film and for less in others, and
// samples of neighbours count, too (dispersed_rays.hpp), so that a pixel has more of one colour than the next, even
// where all is white. How much is known without the scene: from PixelSum::passed, and from PixelSum::besides, which
// holds what the samples would bring if all that they see were white, less the number of those that pass. In the mean
// of the pixels around, this is what the lens does. What a pixel has beyond that mean is chance, and is taken out of
// its light when the film is developed.

/// Which of these is taken out.
struct FilmBalance {
    bool passes = false;  ///< how many samples pass
    bool wavelengths = false;  ///< how much they count in each channel

    REALCAM_HD bool any() const { return passes || wavelengths; }
};

/// Whether PixelSum::besides is summed for it: where samples have wavelengths, and no layer needs the place.
inline bool balances_wavelengths(const RenderSettings& settings) {
    return settings.effects.have_wavelengths() && !settings.layers.has(Layer::variance) &&
           !settings.layers.has_any(kHalfLayers);
}

/// Where pixels learn their pupils, their shares differ because each sends its samples to other places.
inline FilmBalance film_balance(const RenderSettings& settings) {
    return {settings.pupil_sampling != PupilSampling::pixel, balances_wavelengths(settings)};
}

/// Sums over some pixels of a film that have samples.
struct PixelNeighbourhood {
    static constexpr int kReach = 2;  ///< pixels around one, to all sides
    static constexpr double kEvenSamples = 32;  ///< by pixel; of more, stratification makes the shares more even

    double pixels = 0;
    double share = 0, share_squared = 0;  ///< of a pixel's samples, those that pass
    double chance = 0;  ///< variance of that share, over that of a single sample
    double excess[3] = {0, 0, 0};  ///< of a sample, by channel
    /// Irradiance of a channel, and the sums of excess and of its square that are weighted with it.
    double light[3] = {0, 0, 0}, lit_excess[3] = {0, 0, 0}, lit_square[3] = {0, 0, 0};

    /// How far it reaches from a row or column, one of so many. As far to one side as to the other, so that what
    /// changes evenly over the film has its value in the middle as the mean.
    REALCAM_HD static int reach(int from, int count) {
        constexpr int kMost = kReach;  // a value: device code has no address of the member
        return std::min({kMost, from, count - 1 - from});
    }
    /// The pixels around a place in one column of a film, which is stored row by row.
    REALCAM_HD static PixelNeighbourhood of_column(const PixelSum* film, int width, int height, int column, int row,
                                                   bool has_wavelengths) {
        PixelNeighbourhood sum;
        const int up = reach(row, height);
        for (int y = row - up; y <= row + up; ++y)
            sum.add(film[static_cast<std::int64_t>(y) * width + column], has_wavelengths);
        return sum;
    }
    /// All pixels around a place: of_column(column) gives those of a column.
    template <class OfColumn>
    REALCAM_HD static PixelNeighbourhood around(int column, int width, OfColumn&& of_column) {
        PixelNeighbourhood sum;
        const int left = reach(column, width);
        for (int x = column - left; x <= column + left; ++x) sum += of_column(x);
        return sum;
    }

    REALCAM_HD void add(const PixelSum& pixel, bool has_wavelengths) {
        if (pixel.samples == 0) return;
        const double n = static_cast<double>(pixel.samples), passing = static_cast<double>(pixel.passed) / n;
        pixels += 1;
        share += passing;
        share_squared += passing * passing;
        chance += std::min(1.0, kEvenSamples / n) / n;
        if (!has_wavelengths) return;
        for (int c = 0; c < 3; ++c) {
            const double e = excess_of(pixel, c), lit = pixel.irradiance[c] / n;
            excess[c] += e;
            light[c] += lit;
            lit_excess[c] += lit * e;
            lit_square[c] += lit * e * e;
        }
    }
    REALCAM_HD PixelNeighbourhood& operator+=(const PixelNeighbourhood& other) {
        pixels += other.pixels;
        share += other.share;
        share_squared += other.share_squared;
        chance += other.chance;
        for (int c = 0; c < 3; ++c) {
            excess[c] += other.excess[c];
            light[c] += other.light[c];
            lit_excess[c] += other.lit_excess[c];
            lit_square[c] += other.lit_square[c];
        }
        return *this;
    }
    /// The mean share, and by how much it varies between the pixels.
    REALCAM_HD double mean_share() const { return share / pixels; }
    REALCAM_HD double share_variance() const { return share_squared / pixels - mean_share() * mean_share(); }
    REALCAM_HD double mean_chance() const { return mean_share() * (1 - mean_share()) * chance / pixels; }

    /// Excess of a sample in a pixel. Few samples are by chance so much too coloured that less is taken out of them.
    REALCAM_HD static double excess_of(const PixelSum& pixel, int channel) {
        constexpr double kMost = 0.5;
        return std::clamp(pixel.besides[channel] / static_cast<double>(pixel.samples), -kMost, kMost);
    }
    REALCAM_HD double mean_excess(int channel) const { return excess[channel] / pixels; }
    /// Mean of d (1 - d), d being the excess over the mean, weighted with the light of a channel, of which some pixels
    /// have less than 0.
    REALCAM_HD double lit_chance(int channel) const {
        const double mean = mean_excess(channel), e = lit_excess[channel] / light[channel],
                     square = lit_square[channel] / light[channel];
        return std::clamp(e - mean - (square - 2 * mean * e + mean * mean), -1.0, 1.0);
    }
    /// True if a channel has enough of the light that its weights are positive and their sum is not chance.
    REALCAM_HD bool is_lit(int channel) const {
        constexpr double kLeastShare = 0.2;
        return light[channel] > kLeastShare * std::max({light[0], light[1], light[2]}) && light[channel] > 0;
    }
};

/// By what a pixel's light is multiplied, so that it is that of as many passing samples as its neighbours have. The
/// mean of the samples that pass is right in itself.
///
/// A pupil's outline has a margin, in which one or two in a hundred samples are lost (Pupil). Where more are lost, the
/// picture ends. If the shares of the pixels differ by more than chance can make them, they have other reasons, too. In
/// neither case does the mean say what the share of the pixel in the middle should be.
REALCAM_HD inline double pass_balance(const PixelSum& pixel, const PixelNeighbourhood& around) {
    constexpr std::uint64_t kFewestSamples = 8;  // the share of fewer says little
    constexpr double kLeastShare = 0.96, kMostVariance = 1.75;
    if (pixel.samples < kFewestSamples || pixel.passed == 0) return 1;
    const double share = around.mean_share();
    if (share < kLeastShare || around.share_variance() > kMostVariance * around.mean_chance()) return 1;
    return share * static_cast<double>(pixel.samples) / static_cast<double>(pixel.passed);
}

/// By what a pixel's light is multiplied in a channel, so that it counts as much there as its neighbours do: a control
/// variate, whose factor is the light itself (Owen, Monte Carlo theory, methods and examples, 2013, section 8.9).
///
/// With d, the excess by chance, the light of an evenly white scene is 1 + d. 1 - s d (1 - d) is near 1 / (1 + d) for
/// any share s. Light and d come from the same samples, so that their product has a mean of its own, which depends on
/// the light's colour. The mean of the pixels around, weighted with their light, is that mean. With it taken out, the
/// sum over even light stays, whatever its colour and the number of samples are.
REALCAM_HD inline double wavelength_balance(const PixelSum& pixel, int channel, const PixelNeighbourhood& around) {
    constexpr double kFew = 1;
    if (!around.is_lit(channel)) return 1;
    const double n = static_cast<double>(pixel.samples);
    const double d = PixelNeighbourhood::excess_of(pixel, channel) - around.mean_excess(channel);
    return 1 - n / (n + kFew) * (d * (1 - d) - around.lit_chance(channel));
}

}  // namespace REALCAM_NAMESPACE
