#pragma once
#include <cmath>
#include <limits>

#include "../../math/vec3.hpp"

// Attribute of the hot functions: gcc compiles a version for each of several instruction sets, and the loader picks
// one. clang would require the attribute in the declarations, too, and cannot combine it with `flatten`.
#if defined(__x86_64__) && defined(__linux__) && !defined(__clang__)
#define REALCAM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define REALCAM_CLONES
#endif

namespace REALCAM_NAMESPACE {

/// A number with its derivatives by N variables: forward-mode differentiation. Comparisons use only the value, so that
/// branches are taken as for a plain number.
///
/// Host code only: the derivatives are a vector type of gcc and clang, which maps to one or more registers on any
/// machine.
template <int N>
struct Dual {
    typedef double Derivatives __attribute__((vector_size(8 * N), aligned(8)));

    double value = 0;
    Derivatives by = {};

    Dual() = default;
    // Implicit, because the core writes `T sum = 0`.
    __attribute__((always_inline)) inline Dual(double v) : value(v) {}
    __attribute__((always_inline)) inline Dual(double v, const Derivatives& derivatives) : value(v), by(derivatives) {}

    /// Returns the dual number of f(value), given f and its derivative `slope`.
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

    /// The infinite slope at 0 is taken as 0: for the distance from the axis, at the axis, that is the mean over
    /// directions.
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

template <int N>
double plain_value(const Dual<N>& a) {
    return a.value;
}

template <int N>
bool is_constant_zero(const Dual<N>& a) {
    bool is_zero = a.value == 0;
    for (int lane = 0; lane < N; ++lane) is_zero &= a.by[lane] == 0;
    return is_zero;
}

/// More specialised than the template for plain numbers, so that overload resolution prefers it.
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
