#pragma once
#include <cmath>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Greatest number of calls of f by find_root: every four at least halve the bracket, so that 81 halvings are certain.
/// They determine the root to its last digit in a bracket 2^28 times as wide as the root's magnitude.
inline constexpr int kMaxRootCalls = 324;

struct Root {
    double at, value;  ///< value: f(at); NaN if f returned NaN
};

/// Returns a root of a continuous function between a and b, where it has different signs (f_a = f(a), f_b = f(b)), with
/// |f| at most `tolerance` unless no number is left between. Uses secant steps that halve the function value of an end
/// retained for a second time (M. Dowell and P. Jarratt, "A modified regula falsi method", BIT 11, 168, 1971), and
/// bisection if three of these steps have not halved the bracket. The caller checks the value: at a jump or a pole it
/// is not small.
template <class F>
Root find_root(F&& f, double a, double f_a, double b, double f_b, double tolerance) {
    if (f_a == 0) return {a, f_a};
    Root best = std::fabs(f_a) < std::fabs(f_b) ? Root{a, f_a} : Root{b, f_b};
    double weight_a = f_a, weight_b = f_b;  // function values that the secant uses
    double width = std::fabs(b - a);  // of the bracket, at most four calls ago
    enum class End { none, first, second } kept = End::none;
    for (int call = 0; call < kMaxRootCalls && !(std::fabs(best.value) <= tolerance); ++call) {
        const bool halves = call % 4 == 3 && std::fabs(b - a) > 0.5 * width;
        if (call % 4 == 0) width = std::fabs(b - a);
        const double secant = a - weight_a * ((b - a) / (weight_b - weight_a)), middle = a + 0.5 * (b - a);
        const bool inside = (secant - a) * (b - secant) > 0;
        const double x = halves || !inside ? middle : secant;
        if (x == a || x == b) break;
        const double value = f(x);
        if (std::isnan(value)) return {x, value};
        if (std::fabs(value) < std::fabs(best.value)) best = {x, value};
        if ((value > 0) == (f_b > 0)) {
            b = x, f_b = weight_b = value;
            if (kept == End::first) weight_a *= 0.5;
            kept = End::first;
        } else {
            a = x, f_a = weight_a = value;
            if (kept == End::second) weight_b *= 0.5;
            kept = End::second;
        }
    }
    return best;
}

}  // namespace REALCAM_NAMESPACE
