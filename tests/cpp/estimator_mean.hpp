#pragma once
// Means of samples against a truth, in their own standard errors.

#include <algorithm>
#include <cmath>

#include "doctest/doctest.h"

namespace realcam::test {

/// Estimates are held to 5 standard errors: of the 70 here one would fail with probability 4e-5, and the seeds are
// fixed.
inline constexpr double kErrors = 5;

struct Mean {
    double sum = 0, squares = 0, count = 0;
    void add(double v) {
        sum += v;
        squares += v * v;
        ++count;
    }
    double value() const { return sum / count; }
    double standard_error() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / count); }
    /// Error in units of the standard error, which is at least 1e-6 of the truth, for rounding.
    double off(double truth) const {
        return std::fabs(value() - truth) / std::max(standard_error(), 1e-6 * std::fabs(truth));
    }
};

struct Worst {
    double errors = 0, relative = 0;
    int cases = 0;
    void add(const Mean& mean, double truth) {
        errors = std::max(errors, mean.off(truth));
        relative = std::max(relative, std::fabs(mean.value() / truth - 1));
        ++cases;
        CHECK(mean.off(truth) <= kErrors);
    }
};

}  // namespace realcam::test
