#pragma once
#include <cstddef>
#include <vector>

#include "../platform.hpp"

// Piecewise cubic interpolation of functions of one variable.

namespace REALCAM_NAMESPACE {

/// Slope of a curve at its first and last point.
enum class CurveEnds {
    free,        ///< estimated from the neighbouring points
    zero_slope,  ///< 0
};

/// Curve through points (x, y), by cubic Hermite polynomials. Each segment is monotone: it stays within the values of
/// its two end points. The slope at a point is the weighted harmonic mean of the slopes of the two adjacent chords, or
/// 0 at a local extremum of the points (F. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300). Beyond its
/// ends the curve is constant.
class MonotoneCurve {
public:
    /// Needs at least one point; `x` is strictly increasing.
    MonotoneCurve(std::vector<double> x, std::vector<double> y, CurveEnds ends = CurveEnds::free);

    /// Returns the value of the curve at x.
    double at(double x) const;

private:
    std::vector<double> x_, y_, slopes_;
};

/// Odd function, tabulated at the positions 0, 1, 2, ..., and interpolated between them by cubic Hermite polynomials. A
/// value may be NaN (not known): the function is then NaN there and in the two adjacent intervals.
class OddCurve {
public:
    /// A value and its slope.
    struct Point {
        double value, slope;
    };

    OddCurve() = default;
    /// Needs at least three values. `monotone`: limits the slopes so that each segment is monotone, also where the
    /// slope changes abruptly (F. Fritsch and R. Carlson, SIAM J. Numer. Anal. 17 (1980) 238).
    explicit OddCurve(std::vector<double> values, bool monotone = false);

    int count() const { return static_cast<int>(values_.size()); }
    /// Tabulated value k.
    double operator[](int k) const { return values_[static_cast<std::size_t>(k)]; }

    /// Evaluates the function at position k + t, with t from 0 to 1.
    Point between(int k, double t) const;
    /// Evaluates the function at a position from 0 to count() - 1.
    Point at(double position) const;

private:
    /// Value at any integer, by symmetry for negative ones; NaN beyond the table.
    double value_at(int k) const;

    /// Estimates the slope at k by fourth-order finite differences, or by lower orders at the end and beside values
    /// that are NaN.
    double slope_at(int k) const;

    /// Returns the slope at k, limited so that both adjacent segments are monotone.
    double monotone_slope(int k, double slope) const;

    std::vector<double> values_, slopes_;
};

}  // namespace REALCAM_NAMESPACE
