#pragma once
#include <cmath>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Largest number of calls of f by find_root. Every four calls at least halve the bracket, so that it is halved at
/// least 81 times. This determines the root to its last digit if the bracket is up to 2^28 times as wide as the root's
/// magnitude.
inline constexpr int kMaxRootCalls = 324;

/// Result of find_root.
struct Root {
    double at;     ///< argument
    double value;  ///< f(at); NaN if f returned NaN
};

/// Finds a root of a continuous function between a and b, where its values f_a = f(a) and f_b = f(b) must have
/// different signs. Stops when |f| is at most `tolerance`, when no floating-point number is left between the ends,
/// after kMaxRootCalls calls, or when f returns NaN; returns the argument with the smallest |f|. Callers must check the
/// value: at a jump or a pole of f it is not small.
///
/// Uses the Illinois method: secant steps that halve the function value of an end point that is retained twice in
/// succession (M. Dowell and P. Jarratt, "A modified regula falsi method", BIT 11, 168, 1971). If three of these steps
/// have not halved the bracket, the fourth bisects it.
template <class F>
Root find_root(F&& f, double a, double f_a, double b, double f_b, double tolerance) {
    if (f_a == 0) return {a, f_a};
    Root best = std::fabs(f_a) < std::fabs(f_b) ? Root{a, f_a} : Root{b, f_b};
    double weight_a = f_a, weight_b = f_b;  // function values that the secant uses
    double width = std::fabs(b - a);  // of the bracket, at most four calls ago
    enum class End { none, first, second } retained = End::none;
    for (int call = 0; call < kMaxRootCalls && !(std::fabs(best.value) <= tolerance); ++call) {
        const bool bisects = call % 4 == 3 && std::fabs(b - a) > 0.5 * width;
        if (call % 4 == 0) width = std::fabs(b - a);
        const double secant = a - weight_a * ((b - a) / (weight_b - weight_a)), middle = a + 0.5 * (b - a);
        const bool inside = (secant - a) * (b - secant) > 0;
        const double x = bisects || !inside ? middle : secant;
        if (x == a || x == b) break;
        const double value = f(x);
        if (std::isnan(value)) return {x, value};
        if (std::fabs(value) < std::fabs(best.value)) best = {x, value};
        if ((value > 0) == (f_b > 0)) {
            b = x, f_b = weight_b = value;
            if (retained == End::first) weight_a *= 0.5;
            retained = End::first;
        } else {
            a = x, f_a = weight_a = value;
            if (retained == End::second) weight_b *= 0.5;
            retained = End::second;
        }
    }
    return best;
}

}  // namespace REALCAM_NAMESPACE
