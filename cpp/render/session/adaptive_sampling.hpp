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

/// Divides a range of samples into passes, for pixels that learn their pupils (PixelPupil): a pixel's pupil is updated
/// after each pass, so that what a sample knows follows from its index alone and not from the distribution of samples
/// over threads. Each pass has its own seed: the samples of one low-discrepancy sequence avoid each other, so that the
/// first ones would predict where later ones are missing.
std::vector<SampleRange> learning_passes(const SampleRange& range);

/// Decides which pixels need more samples to reach a noise goal, and how many.
///
/// The film is divided into tiles, and each tile into two halves like the squares of a chessboard. The number of
/// samples of one half is decided by the samples of the other half: a number that depends on the samples themselves
/// would bias their mean, because pixels that happen to miss bright objects seem to have little noise. For the same
/// reason a finished half stays finished, whatever the other half finds later: the other half may have continued
/// because this half had bright samples, and more samples would then average out bright ones only.
///
/// Noise is measured by doubling: the mean of n samples and that of 2 n samples differ by about the error of n samples.
/// The samples of a pixel are stratified, so that in smooth regions its variance falls faster than 1 / n, like n^-p.
/// The variance of the mean of all samples is then that of the last difference over 2^p - 1. p is estimated from the
/// last two doublings of a tile and its neighbours if these show it with some certainty; otherwise it is 1.
///
/// Splatted light (SplattedLight) falls on the whole film, and its noise is independent of that of the pixels' samples.
/// It is measured by the change that more splatted samples make. No more light is splatted once this noise is small in
/// all halves that still need samples.
class AdaptiveSampling {
public:
    /// Approximate side of a tile, pixels.
    static constexpr int kTileSide = 16;

    /// Returns the samples per pixel with which sampling starts. Fewer would not show how noisy the pixels are; more
    /// would be too many in smooth regions.
    static std::int64_t first_samples(const NoiseGoal& goal) { return std::min(std::int64_t{8}, goal.max_samples / 2); }

    /// `width`, `height`: of the film in pixels; `iso`: for noise in 8-bit codes. `exposure`: that of the picture so
    /// far, lux seconds, 3 per pixel; `samples`: sample count of each pixel; `traced`: the splatted part of the
    /// exposure, empty if no light is splatted.
    AdaptiveSampling(int width, int height, const NoiseGoal& goal, double iso, std::span<const float> exposure,
                     const std::vector<std::int64_t>& samples, std::span<const float> traced = {});

    /// Returns the number of additional samples for each pixel; all 0 once finished. `max_total`: approximate limit on
    /// their sum over all pixels.
    std::vector<std::uint32_t> next(double max_total);

    /// True if splatted light is to be taken with these samples, in proportion to the largest number of them in a
    /// pixel.
    bool traces_lights() const { return traces_lights_; }

    /// Updates the estimates of the noise after the samples of next() were taken. `exposure`, `traced`: of the picture
    /// with these samples, as in the constructor; `traced` is read only if traces_lights(). `counts`: the result of
    /// next().
    void add(std::span<const float> exposure, const std::vector<std::uint32_t>& counts,
             std::span<const float> traced = {});

    /// Returns the noise of the noisiest half, and whether the goal is reached.
    ReachedNoise reached() const;

    /// Returns the approximate number of samples, over all pixels, that the goal still requires.
    double left() const;

private:
    /// Largest decay p that is used: two doublings cannot establish a larger one.
    static constexpr double kMaxDecay = 1.25;
    /// Variance of splatted light, as a fraction of the goal's variance, below which no more light is splatted.
    static constexpr double kMaxTracedFraction = 0.2;

    /// Half of a tile. Its pixels have the same number of samples. Values are as in value_of.
    struct Half {
        double pixels = 0, samples = 0;  ///< number of pixels; samples per pixel
        bool is_finished = false;
        double mean = 0;  ///< mean value
        double doublings = 0;  ///< how often the number of samples was doubled
        double square = 0, square_before = 0;  ///< mean square change by the last doubling and by the one before
        double doubled_to = 0;  ///< samples per pixel after the last doubling
        double traced = 0;  ///< variance due to splatted light; infinite until it is measured

        /// Counts `taken` more samples per pixel, which changed the values by the mean square `change`.
        void add(double change, double taken);
    };

    /// Returns the number of tiles along a side of the film.
    static int tiles_of(int pixels) { return std::max(1, (pixels + kTileSide / 2) / kTileSide); }

    /// Calls f(pixel index, index of its half) for each pixel.
    template <class F>
    void for_pixels(F&& f) const {
        for (int y = 0; y < height_; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
            for (int x = 0; x < width_; ++x)
                f(row + static_cast<std::size_t>(x),
                  half_at(y * down_ / height_, x * across_ / width_, static_cast<std::size_t>((x + y) % 2)));
        }
    }

    /// Returns the index in halves_ of half 0 or 1 of the tile in a row and column of tiles.
    std::size_t half_at(int row, int column, std::size_t half) const;

    /// Returns the index of the other half of a tile.
    std::size_t other(std::size_t half) const;

    /// Converts an exposure to the unit in which noise is measured: sensor values (1 is white), or 8-bit codes.
    float value_of(float exposure) const;

    /// Returns the decay p of a half, estimated from the halves of the same chessboard colour in its tile and the
    /// adjacent tiles; at least 1.
    double decay_of(std::size_t half) const;

    /// Returns the variance of a pixel's mean at which the goal is reached.
    double goal_variance(const Half& half) const;

    /// Returns the variance of a pixel's mean over that of the goal.
    double variance_ratio(std::size_t half) const;

    /// Fraction of the goal's variance that is aimed for: measurements are uncertain, and sampling ends where one
    /// happens to be small.
    static constexpr double kMargin = 0.8;

    /// Returns the expected samples per pixel with which the goal is reached; infinite before the first doubling.
    double samples_at_goal(std::size_t half) const;

    /// Returns the additional samples per pixel of a half: as many as it has, or fewer if these are expected to
    /// suffice. `end`: samples_at_goal of the other half.
    double additional_samples(const Half& half, double end) const;

    int width_, height_;
    NoiseGoal goal_;
    double iso_;
    int across_, down_;  ///< number of tiles along the width and the height
    std::vector<Half> halves_;  ///< two per tile, tile by tile
    std::vector<float> values_;  ///< value of each channel of each pixel, with all samples so far
    std::vector<float> traced_;  ///< splatted part of the exposure at the last measurement
    double traced_samples_;  ///< samples per pixel to which that splatted light belongs
    bool traces_lights_ = true;
};

}  // namespace REALCAM_NAMESPACE
