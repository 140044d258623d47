#pragma once
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// What a curve does at its first and at its last point.
enum class CurveEnds {
    free,  ///< it goes on as the points beside the end say
    rest,  ///< its slope is 0
};

/// A curve through points, of cubics (Hermite) that never go beyond the two points between which they lie. Its slopes
/// are continuous: weighted harmonic means of those of the two chords, or 0 where the points turn round
/// (F. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300). Beyond the ends it stays at their values.
class MonotoneCurve {
public:
    /// One point at least; `x` rises.
    MonotoneCurve(std::vector<double> x, std::vector<double> y, CurveEnds ends = CurveEnds::free);

    double at(double x) const;

private:
    std::vector<double> x_, y_, slopes_;
};

}  // namespace REALCAM_NAMESPACE
