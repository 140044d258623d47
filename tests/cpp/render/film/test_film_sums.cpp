#include "render/film/film_sums.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "doctest/doctest.h"

using namespace realcam;

TEST_CASE("each pixel is developed with its own number of samples") {
    FilmSums film(3);
    film[0] = {{2, 4, 6}, {}, 9, 3, 4, 4};
    film[1] = {{2, 4, 6}, {}, 0, 0, 2, 2};
    const Image image = developed({film.data(), 3, 1}, 2);
    CHECK(std::vector<float>(image.exposure.begin(), image.exposure.end()) ==
          std::vector<float>{1, 2, 3, 2, 4, 6, 0, 0, 0});
    constexpr float none = std::numeric_limits<float>::infinity();
    CHECK(std::vector<float>(image.depth.begin(), image.depth.end()) == std::vector<float>{3, none, none});
    CHECK(samples_of(film) == std::vector<std::int64_t>{4, 2, 0});
    // Exposures of 1 to 6 times middle grey, 10 / ISO lux seconds (ISO 12232): 0.18 to 1.08 of white, by IEC 61966-2-1.
    CHECK(developed_codes({film.data(), 3, 1}, 2, 10, ToneCurve::linear) ==
          std::vector<std::uint8_t>{118, 162, 194, 162, 221, 255, 0, 0, 0});
    film[0] += film[1];
    CHECK(samples_of(film)[0] == 6);
}

TEST_CASE("what a pixel has too much of one colour by chance is taken out, and what all have is kept") {
    // A uniform film of 6 lux; the lens passes a tenth more of the light in red and a tenth less in blue.
    constexpr double kChance = 0.1;
    const PixelSum even = {{6600, 6000, 5400}, {100, 0, -100}, 0, 0, 1000, 1000};
    FilmSums film(81, even);
    PixelSum& pixel = film[40];
    const double chance[3] = {kChance, -kChance, 0.5 * kChance};
    for (std::size_t c = 0; c < 3; ++c) {
        pixel.auxiliary[c] += 1000 * chance[c];
        pixel.irradiance[c] += 6000 * chance[c];
    }
    const FilmView balanced{film.data(), 9, 9, {.wavelengths = true}}, plain{film.data(), 9, 9};
    const Image image = developed(balanced, 1);
    for (std::size_t c = 0; c < 3; ++c) {
        CAPTURE(c);
        const double of_all = even.irradiance[c] / 1000, here = static_cast<double>(image.exposure[3 * 40 + c]);
        // Left are the pixel's own part of the mean of 25, and what is of the second and third order: of a tenth.
        CHECK(std::fabs(here / of_all - 1) < kChance * (0.04 + 0.1) + 2 * kChance * kChance * kChance);
        CHECK(static_cast<double>(image.exposure[c]) == doctest::Approx(of_all).epsilon(1e-6));
    }
    // The same film as codes, and where the sums beside the light are not these.
    CHECK(developed_codes(balanced, 0.01, 100, ToneCurve::film)[3 * 40] <
          developed_codes(plain, 0.01, 100, ToneCurve::film)[3 * 40]);
}

TEST_CASE("a pixel of which more samples pass by chance is as bright as its neighbours") {
    // 98 of 100 samples pass, each with 6 lux; of one pixel 94.
    constexpr double kLux = 6;
    const auto with_passing = [](std::uint64_t samples, std::uint64_t passed) {
        const double light = kLux * static_cast<double>(passed);
        return PixelSum{{light, light, light}, {}, 0, 0, samples, passed};
    };
    FilmSums film(81, with_passing(100, 98));
    film[40] = with_passing(100, 94);
    const FilmView view{film.data(), 9, 9, {.passes = true}};
    const auto exposure = [&](std::size_t pixel) {
        return static_cast<double>(developed(view, 1).exposure[3 * pixel]);
    };
    constexpr double kMean = (24 * 0.98 + 0.94) / 25;
    CHECK(exposure(40) == doctest::Approx(kLux * kMean).epsilon(1e-6));
    CHECK(exposure(30) == doctest::Approx(kLux * kMean).epsilon(1e-6));
    CHECK(exposure(0) == doctest::Approx(kLux * 0.98).epsilon(1e-6));

    // Pixels with different numbers of samples and the same pass rate.
    film[40] = with_passing(200, 196);
    CHECK(exposure(40) == doctest::Approx(kLux * 0.98).epsilon(1e-6));

    // With few samples, or none, the pass rate is not corrected.
    for (PixelSum& pixel : film) pixel = with_passing(6, 6);
    film[40] = with_passing(6, 5);
    CHECK(exposure(40) == doctest::Approx(kLux * 5 / 6).epsilon(1e-6));
    film[40] = with_passing(6, 0);
    CHECK(exposure(40) == 0);
    film[40] = {};
    CHECK(exposure(40) == 0);

    // At the edge of the image, and where the pass rate falls from column to column, each pixel keeps its own rate.
    for (std::size_t i = 0; i < film.size(); ++i) film[i] = with_passing(16, i % 9 < 4 ? 16 : i % 9 == 4 ? 8 : 0);
    CHECK(exposure(39) == kLux);
    CHECK(exposure(40) == kLux / 2);
    CHECK(exposure(41) == 0);
    for (std::size_t i = 0; i < film.size(); ++i) film[i] = with_passing(100, 98 - i % 9);
    for (std::size_t column = 0; column < 9; ++column)
        CHECK(exposure(36 + column) ==
              doctest::Approx(kLux * (0.98 - 0.01 * static_cast<double>(column))).epsilon(1e-6));
}

TEST_CASE("pixels of which not all samples pass have the right light in the mean") {
    for (const std::uint64_t samples : {8, 16, 32}) {
        CAPTURE(samples);
        constexpr int kSide = 256;
        constexpr double kShare = 0.988;
        std::mt19937 random(7);
        std::binomial_distribution<std::uint64_t> passing(samples, kShare);
        FilmSums film(std::size_t{kSide} * kSide);
        for (PixelSum& pixel : film) {
            const std::uint64_t passed = passing(random);
            const double light = static_cast<double>(passed);
            pixel = {{light, light, light}, {}, 0, 0, samples, passed};
        }
        const auto mean_and_variance = [&](const FilmControlVariates& balance) {
            const Image image = developed({film.data(), kSide, kSide, balance}, 1);
            double sum = 0, squares = 0;
            for (const float e : image.exposure) {
                sum += static_cast<double>(e);
                squares += std::pow(static_cast<double>(e), 2);
            }
            const double n = static_cast<double>(image.exposure.size());
            return std::pair(sum / n, squares / n - sum * sum / (n * n));
        };
        const auto [mean, variance] = mean_and_variance({.passes = true});
        const auto [plain_mean, plain_variance] = mean_and_variance({});
        // The film's mean is known to its own noise. What is taken out keeps it, but for pixels near the film's edges.
        const double error = std::sqrt(kShare * (1 - kShare) / static_cast<double>(samples)) / kSide;
        CHECK(std::fabs(plain_mean - kShare) < 4 * error);
        CHECK(std::fabs(mean - plain_mean) < error);
        // The mean of 25 pixels has a 25th of the variance. In some neighbourhoods the shares differ by chance by more
        // than is believed.
        CHECK(variance < 0.1 * plain_variance);
    }
}

TEST_CASE("the variance of a pixel is that of the mean of its samples") {
    FilmSums film(2);
    // Samples 1, 2 and 6 of one channel: their variance is 7, that of their mean 7 / 3, after 2 s four times as much.
    film[0] = {{9, 0, 3}, {41, 0, 3}, 0, 0, 3, 3};
    film[1] = {{5, 5, 5}, {25, 25, 25}, 0, 0, 1, 1};
    const LayerImage variance = developed_variance({film.data(), 2, 1}, 2);
    REQUIRE(variance.values.size() == 6);
    CHECK(double(variance.values[0]) == doctest::Approx(28.0 / 3));
    CHECK(variance.values[1] == 0);
    CHECK(variance.values[2] == 0);
    for (std::size_t i = 3; i < 6; ++i) CHECK(std::isnan(variance.values[i]));
}
