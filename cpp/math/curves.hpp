#pragma once
#include <cstddef>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Slope of a curve at its first and last point.
enum class CurveEnds {
    free,  ///< estimated from the points beside the end
    rest,  ///< 0
};

/// Curve through points, by cubic Hermite polynomials that never leave the range between the two points where they lie.
/// Slopes are continuous: weighted harmonic means of those of the two chords, or 0 at a local extremum of the points
/// (F. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300). Constant beyond the ends.
class MonotoneCurve {
public:
    /// Needs at least one point; `x` is strictly increasing.
    MonotoneCurve(std::vector<double> x, std::vector<double> y, CurveEnds ends = CurveEnds::free);

    double at(double x) const;

private:
    std::vector<double> x_, y_, slopes_;
};

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
