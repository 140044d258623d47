#pragma once
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

}  // namespace REALCAM_NAMESPACE
