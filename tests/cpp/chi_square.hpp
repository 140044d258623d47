#pragma once
// Pearson's chi-square test of samples against a density that is integrated by quadrature, with its helpers.

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "math/vec3.hpp"
#include "measurement.hpp"

namespace realcam::test {

/// Chance that right samplers fail anywhere among all the tests here. The seeds are fixed: a test passes always or
/// never.
inline constexpr double kFamilyLevel = 0.01;
/// More than there are.
inline constexpr int kTestsInAll = 400;

/// Level of one test (Sidak 1967): 2.5e-5.
inline double level_of_one_test() {
    return 1 - std::pow(1 - kFamilyLevel, 1.0 / kTestsInAll);
}

/// Independent uniform numbers with the 24 bits of the renderer's own. Those are too even for a chi-square test: within
/// a pixel they are a (0,2)-sequence.
class Uniform {
public:
    explicit Uniform(unsigned seed) : engine_(seed) {}
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    Vec2f pair() {
        const float x = (*this)();
        return {x, (*this)()};
    }

private:
    std::mt19937 engine_;
};

/// Inputs that a warp of the unit square must handle: its edges, its centre, and numbers just inside the edges.
inline std::vector<Vec2f> extreme_inputs() {
    std::vector<Vec2f> all;
    for (const float x : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffcp-1f, 0x1.fffffep-1f})
        for (const float y : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffcp-1f, 0x1.fffffep-1f}) all.push_back({x, y});
    return all;
}

/// Integral of f(x, y) over a rectangle: Gauss's rule of 7 x 7 points in each of pieces x pieces parts.
template <class F>
double integral(F&& f, double x0, double x1, double y0, double y1, int pieces) {
    using Gauss = boost::math::quadrature::gauss<double, 7>;
    const double dx = (x1 - x0) / pieces, dy = (y1 - y0) / pieces;
    double sum = 0;
    for (int i = 0; i < pieces; ++i)
        for (int k = 0; k < pieces; ++k)
            sum += Gauss::integrate(
                [&](double x) {
                    return Gauss::integrate([&](double y) { return static_cast<double>(f(x, y)); }, y0 + k * dy,
                                            y0 + (k + 1) * dy);
                },
                x0 + i * dx, x0 + (i + 1) * dx);
    return sum;
}

/// A table of bins over a rectangle between given edges.
class Bins {
public:
    Bins(std::vector<double> x_edges, std::vector<double> y_edges)
        : x_(std::move(x_edges)),
          y_(std::move(y_edges)),
          expected((x_.size() - 1) * (y_.size() - 1)),
          counts(expected) {}

    static std::vector<double> even(double low, double high, int count) {
        std::vector<double> edges;
        for (int i = 0; i <= count; ++i) edges.push_back(low + (high - low) * i / count);
        return edges;
    }

    /// Expects `samples` times the integral of density(x, y), which contains the area element.
    template <class F>
    void expect(F&& density, double samples, int pieces) {
        for (std::size_t i = 0; i + 1 < x_.size(); ++i)
            for (std::size_t k = 0; k + 1 < y_.size(); ++k)
                expected[i * (y_.size() - 1) + k] =
                    samples * integral(density, x_[i], x_[i + 1], y_[k], y_[k + 1], pieces);
    }

    /// Counts a sample; outside of all bins it is an outlier.
    void add(double x, double y) {
        const int i = interval(x_, x), k = interval(y_, y);
        if (i < 0 || k < 0) {
            ++outliers;
        } else {
            ++counts[static_cast<std::size_t>(i) * (y_.size() - 1) + static_cast<std::size_t>(k)];
        }
    }

private:
    static int interval(const std::vector<double>& edges, double v) {
        if (!(v >= edges.front() && v <= edges.back())) return -1;
        const auto after = std::upper_bound(edges.begin(), edges.end(), v);
        return static_cast<int>(std::min(after - edges.begin(), static_cast<std::ptrdiff_t>(edges.size()) - 1)) - 1;
    }

    std::vector<double> x_, y_;

public:
    std::vector<double> expected, counts;
    double outliers = 0;
};

/// Probability of a statistic like this one or a larger one. Bins in which fewer than 5 are expected go together.
inline double p_value(const std::vector<double>& expected, const std::vector<double>& counts) {
    double statistic = 0, rare = 0, rare_count = 0;
    int bins = 0;
    const auto add = [&](double e, double n) {
        statistic += (n - e) * (n - e) / e;
        ++bins;
    };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] >= 5) {
            add(expected[i], counts[i]);
        } else {
            rare += expected[i];
            rare_count += counts[i];
        }
    }
    if (rare >= 5) {
        add(rare, rare_count);
    } else if (rare_count > 25) {
        return 0;  // of fewer than 5: Poisson's chance is below 1e-10
    }
    if (bins < 2) return 1;
    return boost::math::cdf(boost::math::complement(boost::math::chi_squared(bins - 1), statistic));
}

/// The worst of several tests of one sampler, as a measurement.
class ChiSquareTests {
public:
    explicit ChiSquareTests(std::string sampler) : sampler_(std::move(sampler)) {}

    void add(const std::vector<double>& expected, const std::vector<double>& counts, double outliers = 0) {
        double samples = outliers, total = 0;
        for (const double n : counts) samples += n;
        for (const double e : expected) total += e;
        samples_ += samples;
        bins_ += static_cast<double>(expected.size());
        ++tests_;
        // The density integrates to 1: the difference of `total` from it is the error of the quadrature.
        total_error_ = std::max(total_error_, std::fabs(total / samples - 1));
        const double p = outliers > 0 ? 0 : p_value(expected, counts);
        worst_ = std::max(worst_, -std::log10(std::max(p, 1e-300)));
    }
    void add(const Bins& bins) { add(bins.expected, bins.counts, bins.outliers); }

    /// `total_limit`: by how much the density's integral may differ from 1.
    void hold(double total_limit = 1e-3) const {
        CAPTURE(sampler_);
        CHECK(total_error_ <= total_limit);
        test::hold(measurement());
    }
    void breaks() const { test::breaks(measurement()); }

private:
    Measurement measurement() const {
        char tried[120];
        std::snprintf(tried, sizeof tried, "%d chi-square tests, %.0f samples, %.0f bins; level %.1e each", tests_,
                      samples_, bins_, level_of_one_test());
        return {"Samplers", sampler_, tried, "core", "float32", worst_, -std::log10(level_of_one_test()), "-log10 p"};
    }

    std::string sampler_;
    int tests_ = 0;
    double samples_ = 0, bins_ = 0, total_error_ = 0, worst_ = 0;
};

}  // namespace realcam::test
