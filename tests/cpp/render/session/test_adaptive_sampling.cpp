// Distribution of samples over pictures of known noise.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "doctest/doctest.h"
#include "render/session/adaptive_sampling.hpp"

using namespace realcam;

namespace {

/// Grey pixels whose means of n samples err by sigma n^(-decay / 2), like those of stratified samples: the error of n
/// samples is the mean of those of both halves.
class NoisyFilm {
public:
    NoisyFilm(int width, int height, double decay) : width_(width), height_(height), decay_(decay), random_(7) {
        errors_.resize(3 * pixels());
        samples.resize(pixels());
    }

    std::size_t pixels() const { return static_cast<std::size_t>(width_ * height_); }

    template <class Sigma>
    void take(const std::vector<std::uint32_t>& counts, Sigma&& sigma) {
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < pixels(); ++i) {
            if (counts[i] == 0) continue;
            const double before = static_cast<double>(samples[i]), after = before + counts[i];
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
                // Changes the variance of the mean from that of `before` samples to that of `after` samples.
                const double was = variance(sigma(i), before), is = variance(sigma(i), after);
                const double keep = before > 0 ? is / was : 0;
                errors_[c] = keep * errors_[c] + std::sqrt(std::max(0.0, is - keep * keep * was)) * normal(random_);
            }
            samples[i] = static_cast<std::int64_t>(after);
        }
    }

    std::vector<float> exposure() const {
        std::vector<float> values(errors_.size());
        for (std::size_t c = 0; c < values.size(); ++c) values[c] = static_cast<float>(kGrey + errors_[c]);
        return values;
    }

    double error(std::size_t pixel) const { return errors_[3 * pixel]; }

    static constexpr double kGrey = 10;
    std::vector<std::int64_t> samples;

private:
    double variance(double sigma, double n) const { return n > 0 ? sigma * sigma * std::pow(n, -decay_) : 0; }

    int width_, height_;
    double decay_;
    std::mt19937_64 random_;
    std::vector<double> errors_;
};

}  // namespace

TEST_CASE("each tile gets the samples that its noise needs") {
    constexpr int kSide = 128;
    const double relative = 0.01;
    for (const double decay : {1.0, 1.5}) {
        CAPTURE(decay);
        NoisyFilm film(kSide, kSide, decay);
        // From left to right 1 to 16 times as noisy.
        const auto sigma = [&](std::size_t i) {
            const double x = static_cast<double>(i % kSide / 16) / 7;
            return NoisyFilm::kGrey * relative * 4 * std::pow(16, x);
        };
        film.take(std::vector<std::uint32_t>(film.pixels(), 8), sigma);
        NoiseGoal goal{relative, NoiseUnit::relative, 1 << 20};
        // Grey is brighter than a hundredth of white.
        AdaptiveSampling tiles(kSide, kSide, goal, 100, film.exposure(), film.samples);
        int rounds = 0;
        for (;; ++rounds) {
            REQUIRE(rounds < 40);
            const std::vector<std::uint32_t> counts = tiles.next(1e18);
            if (*std::max_element(counts.begin(), counts.end()) == 0) break;
            film.take(counts, sigma);
            tiles.add(film.exposure(), counts);
        }
        CHECK(tiles.reached().is_reached);
        CHECK(tiles.left() == 0);
        for (int column = 0; column < 8; ++column) {
            CAPTURE(column);
            double square = 0, count = 0, samples = 0;
            for (int y = 0; y < kSide; ++y)
                for (int x = 16 * column; x < 16 * (column + 1); ++x) {
                    const auto i = static_cast<std::size_t>(y * kSide + x);
                    square += film.error(i) * film.error(i);
                    samples += static_cast<double>(film.samples[i]);
                    ++count;
                }
            // 2048 errors: their root mean square is known within 1.6%. What a half tile of 128 pixels shows in three
            // channels is uncertain by 4%; who stops where it is low stops early, though not by the tile's own error.
            CHECK(std::sqrt(square / count) < 1.1 * relative * NoisyFilm::kGrey);
            const double s = sigma(static_cast<std::size_t>(16 * column)) / (relative * NoisyFilm::kGrey);
            const double needed = std::max(16.0, std::pow(s * s / 0.8, 1 / decay));  // with the margin
            // Each step adds a quarter of the present samples, or doubles them before p is known.
            CHECK(samples / count < 2 * needed);
        }
    }
}

TEST_CASE("light is traced until its noise is small where samples are taken, and no longer") {
    constexpr int kSide = 64;
    const double relative = 0.01, goal_sigma = relative * NoisyFilm::kGrey;
    NoisyFilm film(kSide, kSide, 1);
    // The first tiles want 800 samples, the others 20.
    const auto sigma = [&](std::size_t i) { return goal_sigma * std::sqrt(i % kSide < 16 ? 640.0 : 16.0); };
    // The mean of the traced light errs by this over the root of its samples: by a fifth of the goal's variance at 64.
    const double traced_sigma = goal_sigma * std::sqrt(0.2 * 64);
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    double traced_samples = 0;
    std::vector<double> traced_error(3 * film.pixels());
    const auto trace = [&](double more) {
        for (double& error : traced_error)
            error =
                (traced_samples * error + traced_sigma * std::sqrt(more) * normal(random)) / (traced_samples + more);
        traced_samples += more;
    };
    const auto traced = [&] {
        std::vector<float> exposure;
        for (const double error : traced_error) exposure.push_back(static_cast<float>(0.5 * NoisyFilm::kGrey + error));
        return exposure;
    };
    const auto exposure = [&] {
        std::vector<float> all = film.exposure();
        for (std::size_t c = 0; c < all.size(); ++c) all[c] += static_cast<float>(traced_error[c]);
        return all;
    };
    film.take(std::vector<std::uint32_t>(film.pixels(), 8), sigma);
    trace(8);
    AdaptiveSampling tiles(kSide, kSide, {relative, NoiseUnit::relative, 1 << 20}, 100, exposure(), film.samples,
                           traced());
    for (int round = 0;; ++round) {
        REQUIRE(round < 40);
        const std::vector<std::uint32_t> counts = tiles.next(1e18);
        const std::uint32_t most = *std::max_element(counts.begin(), counts.end());
        if (most == 0) break;
        film.take(counts, sigma);
        if (tiles.traces_lights()) trace(most);
        tiles.add(exposure(), counts, traced());
    }
    CHECK(tiles.reached().is_reached);
    CHECK(film.samples[0] > 600);
    // At 64 samples, or at 128 where chance has one half of a tile look noisier than it is.
    CHECK(traced_samples >= 64);
    CHECK(traced_samples <= 128);
    for (int column = 0; column < 4; ++column) {
        CAPTURE(column);
        double square = 0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 16 * column; x < 16 * (column + 1); ++x) {
                const auto i = static_cast<std::size_t>(y * kSide + x);
                const double error = film.error(i) + traced_error[3 * i];
                square += error * error;
            }
        // 1024 errors: known within 2.2%. Bounds as above.
        CHECK(std::sqrt(square / (16 * kSide)) < 1.1 * goal_sigma);
        // Traced light leaves 0.8 - 0.2 of the variance, so 640 / 0.6 and 16 / 0.6 are needed; steps are doublings.
        CHECK(film.samples[static_cast<std::size_t>(16 * column)] < (column == 0 ? 2000 : 60));
    }
}

TEST_CASE("of noise that is not there no samples are taken, and what is clipped has none in codes") {
    constexpr int kSide = 32;
    const std::vector<std::int64_t> samples(kSide * kSide, 8);
    std::vector<float> exposure(3 * kSide * kSide, 1.0f);
    const std::vector<std::uint32_t> eight(kSide * kSide, 8);
    AdaptiveSampling even(kSide, kSide, {}, 100, exposure, samples);
    CHECK(even.next(1e18) == eight);  // nothing is known yet
    even.add(exposure, eight);
    CHECK(even.next(1e18) == std::vector<std::uint32_t>(kSide * kSide, 0));
    CHECK(even.reached().is_reached);

    AdaptiveSampling bright(kSide, kSide, {}, 1e6, exposure, samples);
    for (std::size_t i = 0; i < exposure.size(); ++i) exposure[i] += 0.5f * static_cast<float>(i % 2);
    bright.add(exposure, eight);
    CHECK(bright.next(1e18) == std::vector<std::uint32_t>(kSide * kSide, 0));
    CHECK(bright.reached().is_reached);
}

TEST_CASE("one half of a tile decides upon the other, within all caps") {
    constexpr int kSide = 16;
    std::vector<float> exposure(3 * kSide * kSide, 1.0f);
    const std::vector<std::uint32_t> eight(kSide * kSide, 8);
    NoiseGoal goal{0.01, NoiseUnit::relative, 20};
    AdaptiveSampling tiles(kSide, kSide, goal, 100, exposure, std::vector<std::int64_t>(kSide * kSide, 8));
    // The black squares of the chessboard change by a half, the white ones not at all.
    for (std::size_t i = 0; i < kSide * kSide; ++i)
        if ((i % kSide + i / kSide) % 2 == 0)
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) exposure[c] = 1.5f;
    tiles.add(exposure, eight);
    const std::vector<std::uint32_t> counts = tiles.next(1e18);
    CHECK(counts[0] == 0);  // white ones are quiet
    CHECK(counts[1] == 4);  // black ones are not; 16 are there, and 20 allowed
    const ReachedNoise reached = tiles.reached();
    CHECK_FALSE(reached.is_reached);
    CHECK(reached.noise == doctest::Approx(0.5 / 1.5));
    CHECK(reached.samples_required == doctest::Approx(16 * std::pow(0.5 / 1.5 / 0.01, 2) / 0.8));
    // A budget of half of the samples that all pixels together need.
    CHECK(tiles.next(128 * 4 / 2)[1] == 2);
    CHECK(tiles.next(-1)[1] == 0);  // no time is left
    CHECK(tiles.left() == 128 * 4);
}

// One sample in 2500 hits the light; in most tiles no sample has hit it when eight or sixteen samples are judged to be
// enough.
TEST_CASE("stopping does not bias the mean") {
    constexpr int kSide = 16, kPictures = 1500;
    constexpr double kDark = 0.08, kLamp = 100, kChance = 4e-4;
    constexpr std::size_t kPixels = kSide * kSide;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform;
    double sum = 0, squares = 0;
    for (int picture = 0; picture < kPictures; ++picture) {
        std::vector<double> light(kPixels);
        std::vector<std::int64_t> samples(kPixels);
        std::vector<float> exposure(3 * kPixels);
        const auto take = [&](const std::vector<std::uint32_t>& counts) {
            for (std::size_t i = 0; i < kPixels; ++i) {
                for (std::uint32_t k = 0; k < counts[i]; ++k)
                    light[i] += kDark + (uniform(random) < kChance ? kLamp : 0);
                samples[i] += counts[i];
                for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
                    exposure[c] = static_cast<float>(light[i] / static_cast<double>(samples[i]));
            }
        };
        const std::vector<std::uint32_t> eight(kPixels, 8);
        take(eight);
        AdaptiveSampling tiles(kSide, kSide, {0.3, NoiseUnit::relative, 256}, 100, exposure, samples);
        for (std::vector<std::uint32_t> counts = eight; *std::max_element(counts.begin(), counts.end()) > 0;
             counts = tiles.next(1e18)) {
            take(counts);
            tiles.add(exposure, counts);
        }
        double mean = 0;
        for (std::size_t i = 0; i < kPixels; ++i) mean += light[i] / static_cast<double>(samples[i]) / kPixels;
        sum += mean / kPictures;
        squares += mean * mean / kPictures;
    }
    const double error = std::sqrt((squares - sum * sum) / kPictures);
    CHECK(error < 0.02 * kLamp * kChance);
    CHECK(std::fabs(sum - (kDark + kLamp * kChance)) < 4 * error);
}
