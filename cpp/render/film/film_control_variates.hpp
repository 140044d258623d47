#pragma once
#include <algorithm>

#include "../../camera/models/camera_view.hpp"
#include "../path/sample_range.hpp"
#include "../settings/render_settings.hpp"
#include "pixel_sum.hpp"

namespace REALCAM_NAMESPACE {

// Control variates that remove the noise of the camera's own sampling from a film when it is developed. There are two:
//
// - Pass rate: by chance, a larger fraction of a pixel's samples passes the lens than of its neighbour's.
// PixelSum::passed
//   counts the samples that pass.
// - Wavelengths: a sample at one wavelength has a weight above one in some channels of the film and below one in
// others,
//   and samples of neighbouring pixels count, too (dispersed_rays.hpp). Even in a uniformly white scene a pixel
//   therefore has more of one colour than its neighbour. PixelSum::auxiliary holds the excess: the sum over all
//   contributions to the pixel if the scene were white, less the number of samples that pass.
//
// Both are known without the scene. Their mean over the surrounding pixels is the effect of the lens; the deviation of
// a pixel from that mean is chance.

/// Selects the control variates of a picture.
struct FilmControlVariates {
    bool passes = false;  ///< for the number of samples that pass
    bool wavelengths = false;  ///< for their weights in each channel

    REALCAM_HD bool any() const { return passes || wavelengths; }
};

/// Returns true if pixels accumulate the excess: samples have wavelengths, and no layer needs PixelSum::auxiliary.
inline bool balances_wavelengths(const RenderSettings& settings) {
    return settings.effects.have_wavelengths() && !settings.layers.has(Layer::variance) &&
           !settings.layers.has_any(kHalfLayers);
}

/// Returns the control variates for these settings. If pixels learn their pupils, `passes` is off: their pass rates
/// differ, because each pixel samples other pupil points.
inline FilmControlVariates film_control_variates(const RenderSettings& settings) {
    return {settings.pupil_sampling != PupilSampling::pixel, balances_wavelengths(settings)};
}

/// Sums over the pixels of a neighbourhood that have samples.
struct PixelNeighbourhood {
    static constexpr int kReach = 2;  ///< radius of the neighbourhood, pixels
    static constexpr double kEvenSamples = 32;  ///< per pixel; with more, stratification makes the pass rates more even

    double pixels = 0;  ///< number of pixels
    double share = 0, share_squared = 0;  ///< pass rate: fraction of a pixel's samples that pass the lens
    double chance = 0;  ///< expected variance of a pixel's pass rate, over that of a single sample
    double excess[3] = {0, 0, 0};  ///< per sample, by channel
    /// Irradiance of a channel, and the sums of excess and of its square, weighted with that irradiance.
    double light[3] = {0, 0, 0}, lit_excess[3] = {0, 0, 0}, lit_square[3] = {0, 0, 0};

    /// Returns the radius of the neighbourhood of row or column `from` of `count`: the same to both sides, so that the
    /// mean of a quantity that changes linearly over the film is its value in the centre.
    REALCAM_HD static int reach(int from, int count) {
        constexpr int kMost = kReach;  // a copy: std::min would need the member's address in device code
        return std::min({kMost, from, count - 1 - from});
    }
    /// Returns the sums over the part of a pixel's neighbourhood in one column, for a film that is stored row by row.
    REALCAM_HD static PixelNeighbourhood of_column(const PixelSum* film, int width, int height, int column, int row,
                                                   bool has_wavelengths) {
        PixelNeighbourhood sum;
        const int up = reach(row, height);
        for (int y = row - up; y <= row + up; ++y)
            sum.add(film[static_cast<std::int64_t>(y) * width + column], has_wavelengths);
        return sum;
    }
    /// Returns the sums over the neighbourhood of a pixel. `of_column(column)`: returns those of one column.
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
    // Mean pass rate, its variance between the pixels, and the variance that is expected by chance.
    REALCAM_HD double mean_share() const { return share / pixels; }
    REALCAM_HD double share_variance() const { return share_squared / pixels - mean_share() * mean_share(); }
    REALCAM_HD double mean_chance() const { return mean_share() * (1 - mean_share()) * chance / pixels; }

    /// Excess per sample of a pixel, clamped: a few samples may by chance have a larger excess than should be removed.
    REALCAM_HD static double excess_of(const PixelSum& pixel, int channel) {
        constexpr double kMost = 0.5;
        return std::clamp(pixel.auxiliary[channel] / static_cast<double>(pixel.samples), -kMost, kMost);
    }
    REALCAM_HD double mean_excess(int channel) const { return excess[channel] / pixels; }
    /// Mean over the pixels of d (1 - d), where d is a pixel's excess less the mean excess, weighted with the
    /// irradiance of a channel. That may be negative in single pixels.
    REALCAM_HD double lit_chance(int channel) const {
        const double mean = mean_excess(channel), e = lit_excess[channel] / light[channel],
                     square = lit_square[channel] / light[channel];
        return std::clamp(e - mean - (square - 2 * mean * e + mean * mean), -1.0, 1.0);
    }
    /// Returns true if a channel has enough of the irradiance to be used as weights: their sum must be significant.
    REALCAM_HD bool is_lit(int channel) const {
        constexpr double kLeastShare = 0.2;
        return light[channel] > kLeastShare * std::max({light[0], light[1], light[2]}) && light[channel] > 0;
    }
};

/// Returns the factor that scales a pixel's irradiance to the pass rate of its neighbours. The mean over the passing
/// samples is unbiased, and the mean rate is that of the pixel where rates change linearly over the film. Their
/// curvature leaves a bias below the spread that is expected by chance: 0.1% of the light in single pixels of a small,
/// coarse film at 128 samples, and less with more samples.
///
/// Samples are taken in a pupil outline with a margin, in which one or two in a hundred are lost (Pupil). If more are
/// lost, the image circle ends there; if the pass rates of the pixels differ by more than chance explains, they have
/// other causes, too. In both cases the mean does not predict the rate of the centre pixel, and the factor is 1.
REALCAM_HD inline double pass_balance(const PixelSum& pixel, const PixelNeighbourhood& around) {
    constexpr std::uint64_t kFewestSamples = 8;  // the pass rate of fewer is too uncertain
    constexpr double kLeastShare = 0.96, kMostVariance = 1.75;
    if (pixel.samples < kFewestSamples || pixel.passed == 0) return 1;
    const double share = around.mean_share();
    if (share < kLeastShare || around.share_variance() > kMostVariance * around.mean_chance()) return 1;
    return share * static_cast<double>(pixel.samples) / static_cast<double>(pixel.passed);
}

/// Returns the factor that scales a pixel's irradiance in a channel to the weights of its neighbours: a control variate
/// whose coefficient is the irradiance itself (Owen, Monte Carlo theory, methods and examples, 2013, section 8.9).
///
/// Let d be the pixel's excess less the mean excess. A uniformly white scene has the irradiance 1 + d, and 1 - d (1 -
/// d) is near 1 / (1 + d). The correction is scaled by n / (n + kFew) for n samples. Light and d come from the same
/// samples, so that their product has a mean of its own, which depends on the light's colour. It is estimated by the
/// mean over the surrounding pixels, weighted with their light, and subtracted, so that the sum over uniform light is
/// unchanged, whatever its colour and the number of samples are.
REALCAM_HD inline double wavelength_balance(const PixelSum& pixel, int channel, const PixelNeighbourhood& around) {
    constexpr double kFew = 1;
    if (!around.is_lit(channel)) return 1;
    const double n = static_cast<double>(pixel.samples);
    const double d = PixelNeighbourhood::excess_of(pixel, channel) - around.mean_excess(channel);
    return 1 - n / (n + kFew) * (d * (1 - d) - around.lit_chance(channel));
}

}  // namespace REALCAM_NAMESPACE

namespace realcam {

/// Returns true if samples also contribute to other pixels than their own, at other wavelengths (SampleSharing). This
/// requires that all pixels take equally many samples and that the excess is accumulated: no layer may need the
/// variance of a pixel's own samples, or those of half the pupil.
inline bool shares_samples(const CameraView& camera, const RenderSettings& settings, const PixelCounts& counts) {
    return camera.effects.share_pixels() && camera.filter == PixelFilter::box && !counts.counts &&
           !camera.pixel_pupils.known && camera.row_time == 0.0f && balances_wavelengths(settings);
}

}  // namespace realcam
