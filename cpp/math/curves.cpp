#include "curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace realcam {

OddCurve::OddCurve(std::vector<double> values, bool monotone) : values_(std::move(values)) {
    for (int k = 0; k < count(); ++k) {
        const double slope = slope_at(k);
        slopes_.push_back(monotone ? monotone_slope(k, slope) : slope);
    }
}

OddCurve::Point OddCurve::between(int k, double t) const {
    const auto i = static_cast<std::size_t>(k);
    const double slope_0 = slopes_[i], slope_1 = slopes_[i + 1], rise = values_[i + 1] - values_[i];
    const double c = 3 * rise - 2 * slope_0 - slope_1, d = slope_0 + slope_1 - 2 * rise;
    return {values_[i] + t * (slope_0 + t * (c + t * d)), slope_0 + t * (2 * c + 3 * t * d)};
}

OddCurve::Point OddCurve::at(double position) const {
    const int k = std::clamp(static_cast<int>(position), 0, count() - 2);
    return between(k, position - k);
}

double OddCurve::value_at(int k) const {
    if (k >= count()) return std::numeric_limits<double>::quiet_NaN();
    return k < 0 ? -(*this)[-k] : (*this)[k];
}

double OddCurve::slope_at(int k) const {
    const auto f = [this](int i) { return value_at(i); };
    const double estimates[] = {(8 * (f(k + 1) - f(k - 1)) - (f(k + 2) - f(k - 2))) / 12, 0.5 * (f(k + 1) - f(k - 1)),
                                0.5 * (3 * f(k) - 4 * f(k - 1) + f(k - 2)), f(k) - f(k - 1), f(k + 1) - f(k)};
    for (const double estimate : estimates)
        if (std::isfinite(estimate)) return estimate;
    return std::numeric_limits<double>::quiet_NaN();
}

double OddCurve::monotone_slope(int k, double slope) const {
    for (const double rise : {value_at(k + 1) - value_at(k), value_at(k) - value_at(k - 1)}) {
        if (!std::isfinite(rise)) continue;
        slope = rise * slope > 0 ? std::copysign(std::min(std::fabs(slope), 3 * std::fabs(rise)), rise) : 0;
    }
    return slope;
}

namespace {

/// Returns the slope at an end point: that of the parabola through it and the next two points, limited so that the
/// segment stays monotone. `near`, `far`: slopes of the first and the second chord from the end; `near_width` and
/// `far_width` are their extents in x.
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
    if (ends == CurveEnds::zero_slope || last == 0) return;
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
