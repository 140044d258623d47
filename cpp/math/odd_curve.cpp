#include "odd_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace realcam {

OddCurve::OddCurve(std::vector<double> values, bool rises_where_values_do) : values_(std::move(values)) {
    for (int k = 0; k < count(); ++k) {
        const double slope = slope_at(k);
        slopes_.push_back(rises_where_values_do ? limited(k, slope) : slope);
    }
}

OddCurve::Point OddCurve::between(int k, double share) const {
    const auto i = static_cast<std::size_t>(k);
    const double from = slopes_[i], to = slopes_[i + 1], rise = values_[i + 1] - values_[i];
    const double c = 3 * rise - 2 * from - to, d = from + to - 2 * rise;
    return {values_[i] + share * (from + share * (c + share * d)), from + share * (2 * c + 3 * share * d)};
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

double OddCurve::limited(int k, double slope) const {
    for (const double rise : {value_at(k + 1) - value_at(k), value_at(k) - value_at(k - 1)}) {
        if (!std::isfinite(rise)) continue;
        slope = rise * slope > 0 ? std::copysign(std::min(std::fabs(slope), 3 * std::fabs(rise)), rise) : 0;
    }
    return slope;
}

}  // namespace realcam
