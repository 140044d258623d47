#pragma once
#include <cmath>
#include <limits>

#include "../../math/vec3.hpp"

// Written before the functions that most of the time goes into. gcc builds them for several machines, of which the
// loader picks one. clang would want it in their declarations, too, and cannot have it beside `flatten`.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define REALCAM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define REALCAM_CLONES
#endif

namespace REALCAM_NAMESPACE {

/// A number with its derivatives by N variables: forward-mode differentiation. Comparisons are those of the value, so
/// that code with choices takes the branch that a plain number takes.
///
/// For the host alone: the derivatives are a vector of gcc and clang, which becomes one or some registers of any
/// machine.
template <int N>
struct Dual {
    typedef double Derivatives __attribute__((vector_size(8 * N), aligned(8)));

    double value = 0;
    Derivatives by = {};

    Dual() = default;
    // Not explicit: the core writes `T sum = 0`.
    __attribute__((always_inline)) inline Dual(double v) : value(v) {}
    __attribute__((always_inline)) inline Dual(double v, const Derivatives& derivatives) : value(v), by(derivatives) {}

    /// f(value), where f has this slope.
    __attribute__((always_inline)) inline Dual mapped(double f, double slope) const { return {f, slope * by}; }

    friend __attribute__((always_inline)) inline Dual operator+(const Dual& a, const Dual& b) {
        return {a.value + b.value, a.by + b.by};
    }
    friend __attribute__((always_inline)) inline Dual operator-(const Dual& a, const Dual& b) {
        return {a.value - b.value, a.by - b.by};
    }
    friend __attribute__((always_inline)) inline Dual operator*(const Dual& a, const Dual& b) {
        return {a.value * b.value, a.by * b.value + a.value * b.by};
    }
    friend __attribute__((always_inline)) inline Dual operator/(const Dual& a, const Dual& b) {
        const double inverse = 1 / b.value, ratio = a.value / b.value;
        return {ratio, (a.by - ratio * b.by) * inverse};
    }
    friend __attribute__((always_inline)) inline Dual operator-(const Dual& a) { return a.mapped(-a.value, -1); }

    __attribute__((always_inline)) inline Dual& operator+=(const Dual& b) { return *this = *this + b; }
    __attribute__((always_inline)) inline Dual& operator-=(const Dual& b) { return *this = *this - b; }

    friend __attribute__((always_inline)) inline constexpr bool operator==(const Dual& a, const Dual& b) {
        return a.value == b.value;
    }
    friend __attribute__((always_inline)) inline constexpr bool operator<(const Dual& a, const Dual& b) {
        return a.value < b.value;
    }
    friend __attribute__((always_inline)) inline constexpr bool operator>(const Dual& a, const Dual& b) {
        return a.value > b.value;
    }
    friend __attribute__((always_inline)) inline constexpr bool operator<=(const Dual& a, const Dual& b) {
        return a.value <= b.value;
    }
    friend __attribute__((always_inline)) inline constexpr bool operator>=(const Dual& a, const Dual& b) {
        return a.value >= b.value;
    }

    /// At 0 the slope, which is infinite, counts as 0: of a distance from the axis, on the axis, this is its mean.
    friend __attribute__((always_inline)) inline Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return a.mapped(root, root > 0 ? 0.5 / root : 0);
    }
    friend __attribute__((always_inline)) inline Dual sqrt_or_zero(const Dual& a) {
        return a.value > 0 ? sqrt(a) : Dual(0);
    }
    friend __attribute__((always_inline)) inline Dual quotient(const Dual& a, const Dual& b) { return a / b; }
    friend __attribute__((always_inline)) inline Dual fabs(const Dual& a) { return a.value < 0 ? -a : a; }
};

/// More special than that of plain numbers, and so chosen in its place.
template <int N>
__attribute__((always_inline)) inline Dual<N> length(Vec3<Dual<N>> a) {
    return sqrt(dot(a, a));
}

template <int N>
__attribute__((always_inline)) inline Vec3d value(const Vec3<Dual<N>>& v) {
    return {v.x.value, v.y.value, v.z.value};
}

}  // namespace REALCAM_NAMESPACE

template <int N>
struct std::numeric_limits<realcam::Dual<N>> : std::numeric_limits<double> {};
