#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "noise_goal.hpp"

namespace REALCAM_NAMESPACE {

/// Where a picture needs more samples, and how many.
///
/// The film is divided into tiles, and each tile into two halves like the squares of a chessboard. How many samples the
/// pixels of one half get is decided by those of the other half. A number of samples that depends on the samples
/// themselves would bias their mean, because pixels that happen to miss bright things look finished. For the same
/// reason a half that is finished stays so, whatever the other one finds later. It may have gone on looking because
/// this half had bright samples; more samples would level these out, and never dark ones.
///
/// Noise is measured by doubling: a picture of n samples and the same with n more differ by as much as n samples err.
/// The samples of a pixel are stratified, so where it is smooth its variance falls faster than 1 / n, like n^-p. The
/// variance of the mean of all samples is then that of the last difference over 2^p - 1. p is estimated from the last
/// two doublings of a tile and its neighbours where these show it with some certainty; else it is 1.
///
/// Light that is traced from the lights (SplattedLight) falls on the whole film, and its noise is apart from that of
/// the pixels' samples. It is measured by what more of it changes, and no more is taken once it is small everywhere
/// where samples are still wanted.
class AdaptiveSampling {
public:
    static constexpr int kTileSide = 16;

    /// What every pixel gets at the beginning. Fewer would tell nothing of how noisy they are; more would be too many
    /// where all is even.
    static std::int64_t first_samples(const NoiseGoal& goal) {
        return std::min(std::int64_t{8}, goal.most_samples / 2);
    }

    /// `exposure`: of the picture so far, 3 per pixel, lux seconds; `samples`: of each pixel; `traced`: what of the
    /// exposure was traced from the lights, empty where nothing is.
    AdaptiveSampling(int width, int height, const NoiseGoal& goal, double iso, std::span<const float> exposure,
                     const std::vector<std::int64_t>& samples, std::span<const float> traced = {});

    /// Samples that each pixel is to get more; all 0: it is finished. `most`: of all pixels together, about.
    std::vector<std::uint32_t> next(double most);

    /// Whether light is to be traced with them, as much as the largest number of samples asks for.
    bool traces_lights() const { return traces_lights_; }

    /// Takes in the picture with these samples, and with the light if it was to be traced; else `traced` is not read.
    void add(std::span<const float> exposure, const std::vector<std::uint32_t>& counts,
             std::span<const float> traced = {});

    ReachedNoise reached() const;

    /// Samples of all pixels that the goal takes from here, about.
    double left() const;

private:
    /// More is too good to be believed of few doublings.
    static constexpr double kMostDecay = 1.25;
    /// The largest variance of traced light of which no more is taken, as a share of the goal's.
    static constexpr double kTracedShare = 0.2;

    /// The pixels of a tile that are decided upon together.
    struct Half {
        double pixels = 0, samples = 0;
        bool is_finished = false;
        double mean = 0;
        double doublings = 0;
        double square = 0, square_before = 0;  ///< mean squares of what the last doubling changed, and the one before
        double doubled_to = 0;  ///< samples after the last doubling
        double traced = 0;  ///< variance of the light that was traced; infinite before it is known

        void add(double change, double taken);
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

    std::size_t half_at(int row, int column, std::size_t half) const;

    std::size_t other(std::size_t half) const;

    float value_of(float exposure) const;

    /// p of a half: by the halves of the same colour of its tile and those about it.
    double decay_of(std::size_t half) const;

    double variance_wanted(const Half& half) const;

    /// Variance of a pixel's mean over that of the goal.
    double excess_of(std::size_t half) const;

    /// What is measured is uncertain, and who stops where it is small stops too early.
    static constexpr double kMargin = 0.8;

    /// Samples of a pixel with which the goal is reached, by what these have shown.
    double end_of(std::size_t half) const;

    /// As many as there are, or fewer where that is expected to be enough.
    double next_of(const Half& half, double end) const;

    int width_, height_;
    NoiseGoal goal_;
    double iso_;
    int across_, down_;
    std::vector<Half> halves_;  ///< two of each tile, tile by tile
    std::vector<float> values_;
    std::vector<float> traced_;
    double traced_samples_;  ///< of a pixel, to which the traced light belongs
    bool traces_lights_ = true;
};

}  // namespace REALCAM_NAMESPACE
