#pragma once
#include <algorithm>

#include "../../camera/models/camera_view.hpp"
#include "../path/sample_range.hpp"
#include "../settings/render_settings.hpp"
#include "pixel_sum.hpp"

namespace REALCAM_NAMESPACE {

// Control variates for noise of a pixel that does not come from the scene. By chance, more samples of a pixel pass the
// lens than of its neighbour. A sample with a wavelength has a weight above one in some channels of the film and below
// one in others, and samples of neighbouring pixels count, too (dispersed_rays.hpp), so that a pixel has more of one
// colour than its neighbour even in a uniformly white picture. Both are known without the scene. PixelSum::passed
// counts the samples that pass. The additional sums of PixelSum hold the excess: the sum that the samples would bring
// if everything they see were white, less the number of those that pass. The mean over the surrounding pixels is the
// effect of the lens. The deviation of a pixel from that mean is chance, and is removed from its light when the film is
// developed.

/// Selects the control variates.
struct FilmControlVariates {
    bool passes = false;  ///< for the number of samples that pass
    bool wavelengths = false;  ///< for their weights in each channel

    REALCAM_HD bool any() const { return passes || wavelengths; }
};

/// True if pixels accumulate the excess: samples have wavelengths, and no layer needs the additional sums of PixelSum.
inline bool balances_wavelengths(const RenderSettings& settings) {
    return settings.effects.have_wavelengths() && !settings.layers.has(Layer::variance) &&
           !settings.layers.has_any(kHalfLayers);
}

/// If pixels learn their pupils, their pass rates differ, because each samples other pupil points; `passes` is then
/// off.
inline FilmControlVariates film_control_variates(const RenderSettings& settings) {
    return {settings.pupil_sampling != PupilSampling::pixel, balances_wavelengths(settings)};
}

/// Sums over neighbouring pixels of a film, of those that have samples.
struct PixelNeighbourhood {
    static constexpr int kReach = 2;  ///< radius of the neighbourhood, pixels
    static constexpr double kEvenSamples = 32;  ///< per pixel; with more, stratification makes the pass rates more even

    double pixels = 0;
    double share = 0, share_squared = 0;  ///< pass rate: fraction of a pixel's samples that pass the lens
    double chance = 0;  ///< variance of the pass rate, over that of a single sample
    double excess[3] = {0, 0, 0};  ///< per sample, by channel
    /// Irradiance of a channel, and the sums of excess and of its square, weighted with that irradiance.
    double light[3] = {0, 0, 0}, lit_excess[3] = {0, 0, 0}, lit_square[3] = {0, 0, 0};

    /// Radius of the neighbourhood of row or column `from` of `count`: the same to both sides, so that the mean of a
    /// quantity that changes linearly over the film is its value in the centre.
    REALCAM_HD static int reach(int from, int count) {
        constexpr int kMost = kReach;  // a value: device code has no address of the member
        return std::min({kMost, from, count - 1 - from});
    }
    /// Neighbourhood in one column of a film that is stored row by row.
    REALCAM_HD static PixelNeighbourhood of_column(const PixelSum* film, int width, int height, int column, int row,
                                                   bool has_wavelengths) {
        PixelNeighbourhood sum;
        const int up = reach(row, height);
        for (int y = row - up; y <= row + up; ++y)
            sum.add(film[static_cast<std::int64_t>(y) * width + column], has_wavelengths);
        return sum;
    }
    /// Neighbourhood of a pixel. `of_column(column)`: sums of one column.
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
    /// Mean pass rate, its variance between the pixels, and the variance that chance explains.
    REALCAM_HD double mean_share() const { return share / pixels; }
    REALCAM_HD double share_variance() const { return share_squared / pixels - mean_share() * mean_share(); }
    REALCAM_HD double mean_chance() const { return mean_share() * (1 - mean_share()) * chance / pixels; }

    /// Excess per sample of a pixel, clamped: a few samples may by chance have a larger excess than should be removed.
    REALCAM_HD static double excess_of(const PixelSum& pixel, int channel) {
        constexpr double kMost = 0.5;
        return std::clamp(pixel.auxiliary[channel] / static_cast<double>(pixel.samples), -kMost, kMost);
    }
    REALCAM_HD double mean_excess(int channel) const { return excess[channel] / pixels; }
    /// Mean of d (1 - d), where d is the excess over the mean, weighted with the light of a channel, which may be
    /// negative in single pixels.
    REALCAM_HD double lit_chance(int channel) const {
        const double mean = mean_excess(channel), e = lit_excess[channel] / light[channel],
                     square = lit_square[channel] / light[channel];
        return std::clamp(e - mean - (square - 2 * mean * e + mean * mean), -1.0, 1.0);
    }
    /// True if a channel has so much of the light that its weights are positive and their sum is significant.
    REALCAM_HD bool is_lit(int channel) const {
        constexpr double kLeastShare = 0.2;
        return light[channel] > kLeastShare * std::max({light[0], light[1], light[2]}) && light[channel] > 0;
    }
};

/// Factor that scales a pixel's light to the pass rate of its neighbours. The mean of the passing samples is itself
/// unbiased.
///
/// A pupil's outline has a margin, in which one or two in a hundred samples are lost (Pupil). If more are lost, the
/// image circle ends there. If the pass rates of the pixels differ by more than chance explains, they have other
/// reasons, too. In both cases the mean does not predict the rate of the centre pixel, and the factor is 1.
REALCAM_HD inline double pass_balance(const PixelSum& pixel, const PixelNeighbourhood& around) {
    constexpr std::uint64_t kFewestSamples = 8;  // the pass rate of fewer is too uncertain
    constexpr double kLeastShare = 0.96, kMostVariance = 1.75;
    if (pixel.samples < kFewestSamples || pixel.passed == 0) return 1;
    const double share = around.mean_share();
    if (share < kLeastShare || around.share_variance() > kMostVariance * around.mean_chance()) return 1;
    return share * static_cast<double>(pixel.samples) / static_cast<double>(pixel.passed);
}

/// Factor that scales a pixel's light in a channel to the weights of its neighbours: a control variate whose
/// coefficient is the light itself (Owen, Monte Carlo theory, methods and examples, 2013, section 8.9).
///
/// With d, the excess by chance, the light of a uniformly white scene is 1 + d, and 1 - d (1 - d) is near 1 / (1 + d).
/// The correction is scaled by n / (n + kFew) for n samples. Light and d come from the same samples, so that their
/// product has a mean of its own, which depends on the light's colour. It is estimated by the mean over the surrounding
/// pixels, weighted with their light, and subtracted, so that the sum over uniform light is unchanged, whatever its
/// colour and the number of samples are.
REALCAM_HD inline double wavelength_balance(const PixelSum& pixel, int channel, const PixelNeighbourhood& around) {
    constexpr double kFew = 1;
    if (!around.is_lit(channel)) return 1;
    const double n = static_cast<double>(pixel.samples);
    const double d = PixelNeighbourhood::excess_of(pixel, channel) - around.mean_excess(channel);
    return 1 - n / (n + kFew) * (d * (1 - d) - around.lit_chance(channel));
}

}  // namespace REALCAM_NAMESPACE

namespace realcam {

/// True if samples also count for wavelengths in other pixels than their own (SampleSharing). All pixels must then draw
/// the same rays equally often, and the contributions of others must be balanced: no layer may need the variance of a
/// pixel's own samples, or those of half the pupil.
inline bool shares_samples(const CameraView& camera, const RenderSettings& settings, const PixelCounts& counts) {
    return camera.effects.share_pixels() && !counts.counts && !camera.pixel_pupils.known && camera.row_time == 0.0f &&
           balances_wavelengths(settings);
}

}  // namespace realcam
