#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
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
/// n^-p; the variance of the mean of all samples is then that of the last difference over 2^p - 1. p is what the last
/// two doublings of a tile and of those about it show with some certainty, and else 1.
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
        values_.reserve(exposure.size());
        for (const float e : exposure) values_.push_back(value_of(e));
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
            const double end = end_of(other(h));
            halves_[h].is_finished |= end <= halves_[h].samples;
            wanted[h] = next_of(halves_[h], end);
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
        std::vector<double> difference(halves_.size()), mean(halves_.size()), taken(halves_.size());
        for_pixels([&](std::size_t pixel, std::size_t half) {
            for (std::size_t c = 3 * pixel; c < 3 * pixel + 3; ++c) {
                if (counts[pixel] > 0) {
                    const float value = value_of(exposure[c]);
                    const double step = static_cast<double>(value) - static_cast<double>(values_[c]);
                    difference[half] += step * step;
                    values_[c] = value;
                }
                mean[half] += static_cast<double>(values_[c]);
            }
            taken[half] = counts[pixel];
        });
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            const double numbers = 3 * std::max(halves_[h].pixels, 1.0);
            halves_[h].mean = mean[h] / numbers;
            if (taken[h] > 0) halves_[h].add(difference[h] / numbers, taken[h]);
        }
    }

    ReachedNoise reached() const {
        ReachedNoise worst{0, true, 0};
        for (std::size_t h = 0; h < halves_.size(); ++h) {
            if (halves_[h].pixels == 0) continue;
            if (halves_[h].doublings == 0) return {};
            const double noise = goal_.noise * std::sqrt(excess_of(h));
            if (noise > worst.noise) worst = {noise, true, end_of(h)};
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
    static constexpr double kMostDecay = 1.25;

    /// The pixels of a tile that are decided upon together.
    struct Half {
        double pixels = 0, samples = 0;
        bool is_finished = false;
        double mean = 0;
        double doublings = 0;
        double square = 0, square_before = 0;  ///< mean squares of what the last doubling changed, and the one before
        double doubled_to = 0;  ///< samples after the last doubling

        void add(double change, double taken) {
            // Of fewer samples than there are the difference says little.
            const bool is_doubling = taken >= samples;
            samples += taken;
            if (!is_doubling) return;
            square_before = square;
            square = change;
            doubled_to = samples;
            ++doublings;
        }
    };

    static int tiles_of(int pixels) { return std::max(1, (pixels + kTileSide / 2) / kTileSide); }

    /// f(pixel, half).
    template <class F>
    void for_pixels(F&& f) const {
        for (int y = 0; y < height_; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
            for (int x = 0; x < width_; ++x)
                f(row + static_cast<std::size_t>(x),
                  half_at(y * down_ / height_, x * across_ / width_, static_cast<std::size_t>((x + y) % 2)));
        }
    }

    std::size_t half_at(int row, int column, std::size_t half) const {
        return 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(across_) +
                    static_cast<std::size_t>(column)) +
               half;
    }

    std::size_t other(std::size_t half) const {
        // Of a picture of one pixel, say, there is no other half.
        return halves_[half ^ 1].pixels > 0 ? half ^ 1 : half;
    }

    float value_of(float exposure) const {
        const auto developed = static_cast<float>(sensor_value(static_cast<double>(exposure), iso_));
        return goal_.unit == NoiseUnit::codes ? code_of(developed) : developed;
    }

    /// p of a half: by the halves of the same colour of its tile and those about it.
    double decay_of(std::size_t half) const {
        const int tile = static_cast<int>(half / 2), row = tile / across_, column = tile % across_;
        double last = 0, before = 0, numbers = 0;
        for (int y = std::max(0, row - 1); y <= std::min(down_ - 1, row + 1); ++y)
            for (int x = std::max(0, column - 1); x <= std::min(across_ - 1, column + 1); ++x) {
                const Half& near = halves_[half_at(y, x, half % 2)];
                if (near.doublings < 2) continue;
                last += near.square * near.pixels;
                before += near.square_before * near.pixels;
                numbers += 3 * near.pixels;
            }
        if (!(last > 0) || !(before > 0)) return 1;
        // Two deviations of the logarithm of a quotient of mean squares over so many numbers.
        return std::clamp(std::log2(before / last) - 2 * std::numbers::log2e * 2 / std::sqrt(numbers), 1.0, kMostDecay);
    }

    /// Variance of a pixel's mean over that of the goal.
    double excess_of(std::size_t half) const {
        constexpr double kDarkest = 0.01;  // of white
        const Half& h = halves_[half];
        const double goal = goal_.unit == NoiseUnit::codes ? goal_.noise : goal_.noise * std::max(h.mean, kDarkest);
        const double decay = decay_of(half);
        return h.square / (std::exp2(decay) - 1) * std::pow(h.doubled_to / h.samples, decay) / (goal * goal);
    }

    /// What is measured is uncertain, and who stops where it is small stops too early.
    static constexpr double kMargin = 0.8;

    /// Samples of a pixel with which the goal is reached, by what these have shown.
    double end_of(std::size_t half) const {
        const Half& h = halves_[half];
        return h.doublings == 0 ? std::numeric_limits<double>::infinity()
                                : h.samples * std::pow(excess_of(half) / kMargin, 1 / decay_of(half));
    }

    /// As many as there are, or fewer where that is expected to be enough.
    double next_of(const Half& half, double end) const {
        const double most = std::min(half.samples, static_cast<double>(goal_.most_samples) - half.samples);
        if (half.is_finished || half.pixels == 0 || most < 1) return 0;
        const double step = std::max(1.0, half.samples / 4);
        return std::clamp(std::ceil((end - half.samples) / step) * step, 0.0, most);
    }

    int width_, height_;
    NoiseGoal goal_;
    double iso_;
    int across_, down_;
    std::vector<Half> halves_;  ///< two of each tile, tile by tile
    std::vector<float> values_;
};

}  // namespace REALCAM_NAMESPACE
