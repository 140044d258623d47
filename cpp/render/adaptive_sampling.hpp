#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "../camera/picture_codes.hpp"
#include "noise_goal.hpp"

namespace REALCAM_NAMESPACE {

/// Where a picture needs more samples, and how many.
///
/// The film is divided into tiles, and each tile into two halves like the squares of a chessboard. How many samples
/// the pixels of one half get is decided by what those of the other half have shown: a number of samples that depends
/// on the samples themselves would bias their mean, because pixels that happen to miss bright things look finished. For
/// the same reason a half that is finished stays so, whatever the other one finds later. It may have gone on looking
/// because this half had bright samples; more samples would level these out, and never dark ones.
///
/// Noise is measured by doubling: a picture of n samples and the same with n more differ by as much as n samples err.
/// The samples of a pixel are stratified, so that where it is smooth its variance falls faster than with 1 / n, like
/// n^-p; the variance of the mean of all samples is then that of the last difference over 2^p - 1. p is what the
/// differences of all doublings show with some certainty, and else 1.
class AdaptiveSampling {
public:
    static constexpr int kTileSide = 16;

    /// `exposure`: of the picture so far, 3 per pixel, lux seconds; `samples`: of each pixel.
    AdaptiveSampling(int width, int height, const NoiseGoal& goal, double iso, const std::vector<float>& exposure,
                     const std::vector<std::int64_t>& samples)
        : width_(width),
          height_(height),
          goal_(goal),
          iso_(iso),
          across_(tiles_of(width)),
          down_(tiles_of(height)),
          halves_(2 * static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)) {
        values_ = values_of(exposure);
        for_pixels([&](std::size_t pixel, std::size_t half) {
            ++halves_[half].pixels;
            halves_[half].samples += static_cast<double>(samples[pixel]);
        });
        for (Half& half : halves_) half.samples = std::max(1.0, half.samples / std::max(half.pixels, 1.0));
    }

    /// Samples that each pixel is to get more; all 0: it is finished. `most`: of all pixels together, about.
    std::vector<std::uint32_t> next(double most) {
        std::vector<double> wanted(halves_.size());
        double sum = 0;
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            halves_[h].is_finished |= end_of(other(h)) <= halves_[h].samples;
            wanted[h] = next_of(halves_[h], other(h));
            sum += wanted[h] * halves_[h].pixels;
        }
        const double scale = std::clamp(most / std::max(sum, 1.0), 0.0, 1.0);
        std::vector<std::uint32_t> counts(values_.size() / 3);
        for_pixels([&](std::size_t pixel, std::size_t half) {
            counts[pixel] = static_cast<std::uint32_t>(scale * wanted[half]);
        });
        return counts;
    }

    /// Takes in the picture with these samples.
    void add(const std::vector<float>& exposure, const std::vector<std::uint32_t>& counts) {
        const std::vector<float> values = values_of(exposure);
        std::vector<double> difference(halves_.size()), mean(halves_.size()), taken(halves_.size());
        for_pixels([&](std::size_t pixel, std::size_t half) {
            for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
                const double step = static_cast<double>(values[c]) - static_cast<double>(values_[c]);
                difference[half] += step * step;
                mean[half] += static_cast<double>(values[c]);
            }
            taken[half] = counts[pixel];
        });
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            const double numbers = 3 * std::max(halves_[h].pixels, 1.0);
            halves_[h].mean = mean[h] / numbers;
            if (taken[h] > 0) halves_[h].add(difference[h] / numbers, taken[h]);
        }
        values_ = values;
    }

    ReachedNoise reached() const {
        ReachedNoise worst{0, true, 0};
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            if (halves_[h].pixels > 0 && halves_[h].variance < 0) return {};
            const double excess = excess_of(halves_[h]), noise = goal_.noise * std::sqrt(excess);
            if (!(noise > worst.noise)) continue;
            worst = {noise, true, end_of(halves_[h])};
        }
        for (std::size_t h = 0; h < halves_.size(); ++h)
            worst.is_reached &= halves_[h].pixels == 0 || halves_[h].is_finished;
        return worst;
    }

    /// Samples of all pixels that the goal takes from here, about.
    double left() const {
        double sum = 0;
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            if (halves_[h].is_finished) continue;
            const double end = std::min(end_of(other(h)), static_cast<double>(goal_.most_samples));
            sum += halves_[h].pixels * std::max(0.0, end - halves_[h].samples);
        }
        return sum;
    }

private:
    /// More is too good to be believed of few doublings.
    static constexpr double kMostDecay = 1.5;

    /// The pixels of a tile that are decided upon together.
    struct Half {
        double pixels = 0, samples = 0;
        bool is_finished = false;
        double mean = 0;
        double first_difference = 0, doublings = 0;  ///< mean square of the first doubling; how many there were
        double variance = -1;  ///< of a pixel's mean; below 0: not known yet
        double decay = 1;  ///< p: variance falls with samples^-p

        void add(double square, double taken) {
            if (taken < samples) {
                variance *= std::pow(samples / (samples + taken), decay);
            } else {
                // A mean square over 128 pixels is uncertain by a fifth and more, the logarithm of a quotient by a
                // half.
                if (doublings == 0)
                    first_difference = square;
                else if (square > 0)
                    decay = std::clamp((std::log2(first_difference / square) - 0.5) / doublings, 1.0, kMostDecay);
                ++doublings;
                variance = square / (std::exp2(decay) - 1);
            }
            samples += taken;
        }
    };

    static int tiles_of(int pixels) { return std::max(1, (pixels + kTileSide / 2) / kTileSide); }

    /// f(pixel, half).
    template <class F>
    void for_pixels(F&& f) const {
        for (int y = 0; y < height_; ++y) {
            const std::size_t row = static_cast<std::size_t>(y * down_ / height_) * static_cast<std::size_t>(across_);
            for (int x = 0; x < width_; ++x)
                f(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x),
                  2 * (row + static_cast<std::size_t>(x * across_ / width_)) + static_cast<std::size_t>((x + y) % 2));
        }
    }

    const Half& other(std::size_t half) const {
        // Of a picture of one pixel, say, there is no other half.
        return halves_[half ^ 1].pixels > 0 ? halves_[half ^ 1] : halves_[half];
    }

    std::vector<float> values_of(const std::vector<float>& exposure) const {
        std::vector<float> values = exposure;
        for (float& value : values) {
            const double developed = sensor_value(static_cast<double>(value), iso_);
            value = static_cast<float>(goal_.unit == NoiseUnit::codes ? code_of(developed) : developed);
        }
        return values;
    }

    /// Variance over that of the goal.
    double excess_of(const Half& half) const {
        constexpr double kDarkest = 0.01;  // of white
        const double goal = goal_.unit == NoiseUnit::codes ? goal_.noise : goal_.noise * std::max(half.mean, kDarkest);
        return half.variance / (goal * goal);
    }

    /// What is measured is uncertain, and who stops where it is small stops too early.
    static constexpr double kMargin = 0.8;

    /// Samples of a pixel with which the goal is reached, by what these have shown.
    double end_of(const Half& shown) const {
        return shown.variance < 0 ? std::numeric_limits<double>::infinity()
                                  : shown.samples * std::pow(excess_of(shown) / kMargin, 1 / shown.decay);
    }

    /// Of a half, by what the other has shown: as many as it has, or fewer where that is expected to be enough.
    double next_of(const Half& half, const Half& shown) const {
        const double most = std::min(half.samples, static_cast<double>(goal_.most_samples) - half.samples);
        if (half.is_finished || half.pixels == 0 || most < 1) return 0;
        // Where samples are better than random because they are stratified, they are so in powers of two.
        const double step = std::max(1.0, shown.decay > 1 ? half.samples : half.samples / 4);
        return std::clamp(std::ceil((end_of(shown) - half.samples) / step) * step, 0.0, most);
    }

    int width_, height_;
    NoiseGoal goal_;
    double iso_;
    int across_, down_;
    std::vector<Half> halves_;  ///< two of each tile, tile by tile
    std::vector<float> values_;
};

}  // namespace REALCAM_NAMESPACE
