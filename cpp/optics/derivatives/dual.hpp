#pragma once
#include <cmath>
#include <limits>

#include "../../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// A number with its derivatives by N variables: forward-mode differentiation. Comparisons are those of the value, so
/// that code with choices takes the branch that a plain number takes.
template <int N>
struct Dual {
    double value = 0;
    double by[N] = {};

    Dual() = default;
    // Not explicit: the core writes `T sum = 0`.
    REALCAM_INLINE Dual(double v) : value(v) {}
    /// The variable of a lane itself.
    static Dual variable(double v, int lane) {
        Dual result(v);
        result.by[lane] = 1;
        return result;
    }

    /// f(value), where f has this slope.
    REALCAM_INLINE Dual mapped(double f, double slope) const {
        Dual result(f);
        for (int i = 0; i < N; ++i) result.by[i] = slope * by[i];
        return result;
    }

    friend REALCAM_INLINE Dual operator+(const Dual& a, const Dual& b) {
        Dual r(a.value + b.value);
        for (int i = 0; i < N; ++i) r.by[i] = a.by[i] + b.by[i];
        return r;
    }
    friend REALCAM_INLINE Dual operator-(const Dual& a, const Dual& b) {
        Dual r(a.value - b.value);
        for (int i = 0; i < N; ++i) r.by[i] = a.by[i] - b.by[i];
        return r;
    }
    friend REALCAM_INLINE Dual operator*(const Dual& a, const Dual& b) {
        Dual r(a.value * b.value);
        for (int i = 0; i < N; ++i) r.by[i] = a.by[i] * b.value + a.value * b.by[i];
        return r;
    }
    friend REALCAM_INLINE Dual operator/(const Dual& a, const Dual& b) {
        const double inverse = 1 / b.value, ratio = a.value / b.value;
        Dual r(ratio);
        for (int i = 0; i < N; ++i) r.by[i] = (a.by[i] - ratio * b.by[i]) * inverse;
        return r;
    }
    friend REALCAM_INLINE Dual operator-(const Dual& a) { return a.mapped(-a.value, -1); }

    REALCAM_INLINE Dual& operator+=(const Dual& b) { return *this = *this + b; }
    REALCAM_INLINE Dual& operator-=(const Dual& b) { return *this = *this - b; }

    friend REALCAM_INLINE constexpr bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
    friend REALCAM_INLINE constexpr bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
    friend REALCAM_INLINE constexpr bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
    friend REALCAM_INLINE constexpr bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
    friend REALCAM_INLINE constexpr bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

    /// At 0 the slope, which is infinite, counts as 0: of a distance from the axis, on the axis, this is its mean.
    friend REALCAM_INLINE Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return a.mapped(root, root > 0 ? 0.5 / root : 0);
    }
    friend REALCAM_INLINE Dual sqrt_or_zero(const Dual& a) { return a.value > 0 ? sqrt(a) : Dual(0); }
    friend REALCAM_INLINE Dual quotient(const Dual& a, const Dual& b) { return a / b; }
    friend REALCAM_INLINE Dual fabs(const Dual& a) { return a.value < 0 ? -a : a; }
};

/// More special than that of plain numbers, and so chosen in its place.
template <int N>
REALCAM_INLINE Dual<N> length(Vec3<Dual<N>> a) {
    return sqrt(dot(a, a));
}

}  // namespace REALCAM_NAMESPACE

template <int N>
struct std::numeric_limits<realcam::Dual<N>> : std::numeric_limits<double> {};
