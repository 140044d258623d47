#pragma once
#include <cstddef>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Odd function tabulated at 0, 1, 2, ..., with cubics between these points (Hermite). NaN at points without a value,
/// and in the intervals beside them.
class OddCurve {
public:
    /// A value and its slope.
    struct Point {
        double value, slope;
    };

    OddCurve() = default;
    /// Needs at least three values. `rises_where_values_do`: limits the slopes so that cubics between increasing values
    /// never fall, also where the function bends (F. Fritsch and R. Carlson, SIAM J. Numer. Anal. 17 (1980) 238).
    explicit OddCurve(std::vector<double> values, bool rises_where_values_do = false);

    int count() const { return static_cast<int>(values_.size()); }
    double operator[](int k) const { return values_[static_cast<std::size_t>(k)]; }

    /// Evaluates the function in the interval that begins at k; `share` from 0 to 1.
    Point between(int k, double share) const;
    Point at(double position) const;

private:
    double value_at(int k) const;

    /// Estimates the slope by fourth-order finite differences; by lower orders at the end and beside gaps.
    double slope_at(int k) const;

    double limited(int k, double slope) const;

    std::vector<double> values_, slopes_;
};

}  // namespace REALCAM_NAMESPACE
