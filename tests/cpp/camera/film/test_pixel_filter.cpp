// Pixel filters: their distributions, against closed forms.

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "camera/film/pixel_filter.hpp"
#include "doctest/doctest.h"

namespace {

using namespace realcam;

/// Integral of a filter from minus infinity to x, in closed form.
double cumulative(PixelFilter filter, double x) {
    const double radius = filter == PixelFilter::tent ? 1.0 : filter == PixelFilter::box ? 0.5 : 1.5;
    if (x <= -radius) return 0;
    if (x >= radius) return 1;
    if (filter == PixelFilter::box) return x + 0.5;
    if (filter == PixelFilter::tent) return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
    const auto integral = [](double at) {
        return std::sqrt(std::numbers::pi / 8) * std::erf(std::numbers::sqrt2 * at) - std::exp(-4.5) * at;
    };
    return 0.5 + integral(x) / (2 * integral(1.5));
}

constexpr PixelFilter kFilters[] = {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian};

TEST_CASE("samples of a pixel filter have its distribution") {
    for (const PixelFilter filter : kFilters) {
        CAPTURE(static_cast<int>(filter));
        constexpr int kSteps = 1 << 14;
        for (int i = 0; i < kSteps; ++i) {
            const double u = (i + 0.5) / kSteps, x = static_cast<double>(sample_filter(filter, static_cast<float>(u)));
            CHECK(std::fabs(x) <= static_cast<double>(filter_radius(filter)) + 2e-5);
            // The approximation errs by 2e-5 pixels, and the density is at most 1.
            CHECK(std::fabs(cumulative(filter, x) - u) < 2e-5);
        }
    }
}

TEST_CASE("the values of a pixel filter are the derivative of its integral") {
    for (const PixelFilter filter : kFilters)
        for (int i = -64; i < 64; ++i) {
            const double x = (i + 0.5) / 40, h = 1e-3;
            const auto radius = static_cast<double>(filter_radius(filter));
            if (std::fabs(std::fabs(x) - radius) < h || std::fabs(x) < h) continue;
            const double wanted = (cumulative(filter, x + h) - cumulative(filter, x - h)) / (2 * h);
            // h^2 / 6 times the second derivative, at most 4, of the value.
            CHECK(std::fabs(static_cast<double>(filter_value(filter, static_cast<float>(x)).value) - wanted) < 1e-6);
        }
}

TEST_CASE("light at a film point is divided among pixels by their filters") {
    constexpr int kSteps = 4096;
    for (const PixelFilter filter : {PixelFilter::tent, PixelFilter::gaussian})
        for (const float position : {3.5f, 3.6f, 4.0f, 4.37f, -0.2f}) {
            CAPTURE(position);
            double parts[12] = {};
            for (int i = 0; i < kSteps; ++i) {
                const FilterChoice choice = choose_by_filter(filter, position, (static_cast<float>(i) + 0.5f) / kSteps);
                parts[choice.index + 4] += static_cast<double>(choice.weight) / kSteps;
            }
            for (int pixel = -4; pixel < 8; ++pixel) {
                const double distance = static_cast<double>(position) - 0.5 - pixel;
                const double wanted = static_cast<double>(filter_value(filter, static_cast<float>(distance)).value);
                CHECK(std::fabs(parts[pixel + 4] - wanted) < 2.0 / kSteps);  // at most one step of u at each end
            }
        }
}

}  // namespace
