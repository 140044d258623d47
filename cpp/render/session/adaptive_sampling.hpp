#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "../../camera/models/pixel_pupil.hpp"
#include "../../math/random.hpp"
#include "../path/sample_range.hpp"
#include "../settings/noise_goal.hpp"

namespace REALCAM_NAMESPACE {

/// Divides a range into passes. Pixels learn after each pass. The knowledge of a sample must not depend on the
/// distribution of samples over threads, and therefore follows from its index alone. Each pass has its own random
/// numbers: samples of one sequence keep their distance from each other, so that those of the first ones would predict
/// where later ones are missing.
std::vector<SampleRange> learning_passes(const SampleRange& range);

/// Decides which pixels need more samples, and how many.
///
/// The film is divided into tiles, and each tile into two halves like the squares of a chessboard. The number of
/// samples of one half is decided by the samples of the other half. A number that depends on the samples themselves
/// would bias their mean, because pixels that happen to miss bright things look finished. For the same reason a
/// finished half stays finished, whatever the other one finds later. The other half may have continued because this
/// half had bright samples; more samples would level out bright ones and never dark ones.
///
/// Noise is measured by doubling: a picture of n samples and the same picture with n more differ by as much as the
/// error of n samples. The samples of a pixel are stratified, so that in smooth regions its variance falls faster than
/// 1 / n, like n^-p. The variance of the mean of all samples is then that of the last difference over 2^p - 1. p is
/// estimated from the last two doublings of a tile and its neighbours if these show it with some certainty; otherwise
/// it is 1.
///
/// Light that is traced from the lights (SplattedLight) falls on the whole film, and its noise is independent of that
/// of the pixels' samples. It is measured by the change that more of it makes. No more light is traced once this noise
/// is small in all halves that still need samples.
class AdaptiveSampling {
public:
    static constexpr int kTileSide = 16;

    /// Samples per pixel at the start. Fewer would not show how noisy the pixels are; more would be too many in smooth
    /// regions.
    static std::int64_t first_samples(const NoiseGoal& goal) {
        return std::min(std::int64_t{8}, goal.most_samples / 2);
    }

    /// `exposure`: of the picture so far, 3 per pixel, lux seconds; `samples`: per pixel; `traced`: the part of the
    /// exposure that was traced from the lights, empty if no light is.
    AdaptiveSampling(int width, int height, const NoiseGoal& goal, double iso, std::span<const float> exposure,
                     const std::vector<std::int64_t>& samples, std::span<const float> traced = {});

    /// Additional samples for each pixel; all 0 once finished. `most`: approximate limit on their sum over all pixels.
    std::vector<std::uint32_t> next(double most);

    /// True if light is to be traced along with these samples, in proportion to the largest number of samples of a
    /// pixel.
    bool traces_lights() const { return traces_lights_; }

    /// Adds the picture after these samples. `traced` is read only if traces_lights().
    void add(std::span<const float> exposure, const std::vector<std::uint32_t>& counts,
             std::span<const float> traced = {});

    ReachedNoise reached() const;

    /// Approximate number of samples, over all pixels, that the goal still requires.
    double left() const;

private:
    /// Largest decay p that few doublings can establish.
    static constexpr double kMostDecay = 1.25;
    /// Largest variance of traced light with which no more light is traced, as a fraction of the goal's variance.
    static constexpr double kTracedShare = 0.2;

    /// Pixels of a tile whose number of samples is decided together.
    struct Half {
        double pixels = 0, samples = 0;
        bool is_finished = false;
        double mean = 0;
        double doublings = 0;
        double square = 0, square_before = 0;  ///< mean square change by the last doubling and by the one before
        double doubled_to = 0;  ///< samples after the last doubling
        double traced = 0;  ///< variance of the light that was traced; infinite until it is measured

        void add(double change, double taken);
    };

    static int tiles_of(int pixels) { return std::max(1, (pixels + kTileSide / 2) / kTileSide); }

    /// Calls f(pixel, half) for each pixel.
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

    /// Decay p of a half, from the halves of the same colour in its tile and the adjacent tiles.
    double decay_of(std::size_t half) const;

    double variance_wanted(const Half& half) const;

    /// Variance of a pixel's mean over that of the goal.
    double excess_of(std::size_t half) const;

    /// Fraction of the goal that is aimed for: measurements are uncertain, and stopping where one is small stops too
    /// early.
    static constexpr double kMargin = 0.8;

    /// Expected samples per pixel with which the goal is reached; infinite before the first doubling.
    double end_of(std::size_t half) const;

    /// Additional samples per pixel: as many as the half has, or fewer if these are expected to suffice.
    double next_of(const Half& half, double end) const;

    int width_, height_;
    NoiseGoal goal_;
    double iso_;
    int across_, down_;
    std::vector<Half> halves_;  ///< two per tile, tile by tile
    std::vector<float> values_;
    std::vector<float> traced_;
    double traced_samples_;  ///< samples per pixel to which the traced light belongs
    bool traces_lights_ = true;
};

}  // namespace REALCAM_NAMESPACE
