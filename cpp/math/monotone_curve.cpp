#include "monotone_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace realcam {
namespace {

/// Returns the slope at an end point, by the parabola through it and the two points beside it, limited so that the
/// cubic stays monotone. `near`, `far`: slopes of the chords from the end on, over intervals of these widths.
double end_slope(double near_width, double near, double far_width, double far) {
    const double slope = ((2 * near_width + far_width) * near - near_width * far) / (near_width + far_width);
    if (slope * near <= 0) return 0;
    return near * far < 0 && std::fabs(slope) > 3 * std::fabs(near) ? 3 * near : slope;
}

}  // namespace

MonotoneCurve::MonotoneCurve(std::vector<double> x, std::vector<double> y, CurveEnds ends)
    : x_(std::move(x)), y_(std::move(y)), slopes_(x_.size(), 0.0) {
    const std::size_t last = x_.size() - 1;
    const auto width = [&](std::size_t i) { return x_[i + 1] - x_[i]; };
    const auto chord = [&](std::size_t i) { return (y_[i + 1] - y_[i]) / width(i); };
    for (std::size_t i = 1; i < last; ++i) {
        const double before = chord(i - 1), after = chord(i);
        if (!(before * after > 0)) continue;
        const double a = 2 * width(i) + width(i - 1), b = width(i) + 2 * width(i - 1);
        slopes_[i] = (a + b) / (a / before + b / after);
    }
    if (ends == CurveEnds::rest || last == 0) return;
    if (last == 1) {
        slopes_[0] = slopes_[1] = chord(0);
        return;
    }
    slopes_[0] = end_slope(width(0), chord(0), width(1), chord(1));
    slopes_[last] = end_slope(width(last - 1), chord(last - 1), width(last - 2), chord(last - 2));
}

double MonotoneCurve::at(double x) const {
    if (!(x > x_.front())) return y_.front();
    if (x >= x_.back()) return y_.back();
    const auto above = std::upper_bound(x_.begin(), x_.end(), x);
    const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
    const double width = x_[i + 1] - x_[i], t = (x - x_[i]) / width;
    const double rise = y_[i + 1] - y_[i];
    return y_[i] + rise * t * t * (3 - 2 * t) + width * t * (1 - t) * (slopes_[i] * (1 - t) - slopes_[i + 1] * t);
}

}  // namespace realcam
