// The random numbers of the sensor: bell curves and Poisson numbers against their densities, and the functions that
// they are made of against the standard library's.

#include <cmath>
#include <vector>

#include "about.hpp"
#include "camera/sensor/sensor_request.hpp"
#include "camera/sensor/sensor_response.hpp"
#include "chi_square.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("the sensor's logarithm and exponential") {
    double worst = 0;
    for (int i = 1; i < 1000000; ++i) {
        const float v = positive_unit_float(hash32(static_cast<std::uint32_t>(i)));
        const double exact = std::log(static_cast<double>(v));
        worst = std::max(worst, std::fabs(static_cast<double>(log_of_positive(v)) - exact) / std::max(1.0, -exact));
    }
    // Four roundings of 6e-8.
    hold({"Samplers", "logarithm of a fraction", "1e6 numbers", "core", "float32", worst, 2.5e-7, "of it, or of 1"});
    worst = 0;
    for (int i = 0; i <= 400000; ++i) {
        const double x = 1e-4 * i;
        worst = std::max(worst, std::fabs(exp_of_negative(x) * std::exp(x) - 1));
    }
    // The constant log 2 is off by half an ulp, 5.6e-17, and is multiplied by up to 58 for the largest argument; the
    // product, 40, is off by half an ulp, 3.6e-15.
    hold({"Samplers", "exponential", "4e5 numbers up to 40", "core", "float64", worst, 8e-15, "relative"});
}

TEST_CASE("normal_pair: both numbers are normal, and independent") {
    constexpr int kPairs = 1 << 18;
    ChiSquareTests tests("normal_pair");
    for (const std::uint32_t seed : {0u, 9u}) {
        Bins bins(Bins::even(-4, 4, 24), Bins::even(-4, 4, 24));
        bins.expect(
            [](double x, double y) {
                return static_cast<double>(normal_pdf(static_cast<float>(x)) * normal_pdf(static_cast<float>(y)));
            },
            kPairs, 2);
        for (std::uint32_t i = 0; i < kPairs; ++i) {
            const std::uint32_t stream = sensor_noise::stream(i, seed);
            const Vec2f pair = normal_pair(hash32(stream, 0), hash32(stream, 1));
            bins.add(static_cast<double>(pair.x), static_cast<double>(pair.y));
        }
        tests.add(bins.expected, bins.counts);
    }
    tests.hold();
}

TEST_CASE("normal_pair is finite for all bits, and reaches 6.6 deviations") {
    for (const std::uint32_t radius : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
        for (const std::uint32_t angle : {0u, 0x3fffffffu, 0x40000000u, 0x80000000u, 0xffffffffu}) {
            const Vec2f pair = normal_pair(radius, angle);
            CHECK(std::isfinite(pair.x));
            CHECK(std::isfinite(pair.y));
            CHECK(std::hypot(pair.x, pair.y) < 6.8f);
        }
    CHECK(normal_pair(0, 0).x > 6.6f);
}

namespace {

std::vector<double> poisson_probabilities(double mean, std::size_t count) {
    std::vector<double> p(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double x = static_cast<double>(k);
        p[k] = std::exp(x * std::log(mean) - mean - std::lgamma(x + 1));
    }
    return p;
}

template <class F>
void add_poisson(ChiSquareTests& tests, double mean, F&& number) {
    constexpr int kNumbers = 1 << 18;
    const auto last = static_cast<std::size_t>(mean + 12 * std::sqrt(mean) + 20);
    std::vector<double> expected = poisson_probabilities(mean, last), counts(last);
    for (double& e : expected) e *= kNumbers;
    for (std::uint32_t i = 0; i < kNumbers; ++i) ++counts.at(static_cast<std::size_t>(number(i)));
    tests.add(expected, counts);
}

}  // namespace

TEST_CASE("Poisson numbers by rejection and by inversion have their distribution") {
    ChiSquareTests rejection("Poisson numbers by rejection");
    for (const double mean : {10.0, 25.0, 400.0, 12345.6})
        add_poisson(rejection, mean, [&](std::uint32_t i) { return poisson_by_rejection(mean, hash32(i, 5)); });
    rejection.hold();

    ChiSquareTests inversion("Poisson numbers by inversion");
    for (const double mean : {0.01, 1.0, 9.0, 39.9})
        add_poisson(inversion, mean, [&](std::uint32_t i) {
            double means[4] = {mean, 0, 1000, 0.5 * mean}, u[4], count[4];
            for (std::uint32_t k = 0; k < 4; ++k) u[k] = open_unit_double(hash32(i, k));
            invert_poisson(means, u, count);
            CHECK(count[1] == 0);
            return count[0];
        });
    inversion.hold();

    ChiSquareTests broken("Poisson numbers of a mean 1% too large");
    add_poisson(broken, 400, [&](std::uint32_t i) { return poisson_by_rejection(404, hash32(i, 5)); });
    broken.breaks();
}

TEST_CASE("a full well lies where the capacity of EMVA 1288 is measured") {
    // Brute force: of numbers m + sqrt(m) x with a normal x, cut at the full well, the mean m with the largest
    // variance.
    for (const double capacity : {500.0, 9458.0, 120000.0}) {
        const double full = full_well_e(capacity, 0);
        double best = 0, at = 0;
        for (double share = 0.9; share < 1.1; share += 0.0005) {
            const double m = share * capacity;
            double weights = 0, sum = 0, squares = 0;
            for (double x = -8; x <= 8; x += 0.002) {
                const double w = std::exp(-x * x / 2), value = std::min(m + std::sqrt(m) * x, full);
                weights += w;
                sum += w * value;
                squares += w * value * value;
            }
            const double variance = squares / weights - sum / weights * (sum / weights);
            if (variance > best) best = variance, at = m;
        }
        CHECK(at == about(capacity, 0.001));
    }
    CHECK(std::isinf(full_well_e(std::numeric_limits<double>::infinity(), 1)));
}
