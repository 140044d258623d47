#pragma once
#include <cmath>
#include <limits>

#include "../../math/vec3.hpp"

// Attribute of functions that take most of the time: gcc compiles a version for each of several instruction sets, and
// the loader selects one. A build for one machine defines REALCAM_CLONE, the only version that it needs. The attribute
// is not used with clang, which requires it in declarations, too, and cannot combine it with `flatten`.
#if !defined(__x86_64__) || !defined(__linux__) || defined(__clang__)
#define REALCAM_CLONES
#elif defined(REALCAM_CLONE)
#define REALCAM_CLONES __attribute__((target(REALCAM_CLONE)))
#else
#define REALCAM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#endif

namespace REALCAM_NAMESPACE {

/// Dual number: a value with its derivatives by N variables, for forward-mode differentiation. Comparisons use only the
/// value, so that branches are taken as for a plain number.
///
/// This type is for host code only: the derivatives are a vector type of gcc and clang, which is stored in one or more
/// vector registers.
template <int N>
struct Dual {
    /// Vector of N doubles with element-wise arithmetic.
    typedef double Derivatives __attribute__((vector_size(8 * N), aligned(8)));

    double value = 0;
    Derivatives by = {};  ///< by[i]: derivative by variable i

    Dual() = default;
    // The constructor is not explicit, because templates of the core contain expressions such as `T sum = 0`. The
    // derivatives are 0.
    __attribute__((always_inline)) inline Dual(double v) : value(v) {}
    __attribute__((always_inline)) inline Dual(double v, const Derivatives& derivatives) : value(v), by(derivatives) {}

    /// Applies a function to this number: `f` and `slope` are its value and derivative at `value`.
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

    /// Square root. Its derivative at 0, which is infinite, is replaced by 0. For the distance from the axis this is
    /// the mean of the derivatives in all directions.
    friend __attribute__((always_inline)) inline Dual sqrt(const Dual& a) {
        const double root = std::sqrt(a.value);
        return a.mapped(root, root > 0 ? 0.5 / root : 0);
    }
    // Versions of functions in platform.hpp.
    friend __attribute__((always_inline)) inline Dual sqrt_or_zero(const Dual& a) {
        return a.value > 0 ? sqrt(a) : Dual(0);
    }
    friend __attribute__((always_inline)) inline Dual quotient(const Dual& a, const Dual& b) { return a / b; }
    friend __attribute__((always_inline)) inline Dual fabs(const Dual& a) { return a.value < 0 ? -a : a; }
};

/// Returns the value without derivatives.
template <int N>
double plain_value(const Dual<N>& a) {
    return a.value;
}

/// True if the value and all derivatives are 0.
template <int N>
bool is_constant_zero(const Dual<N>& a) {
    bool is_zero = a.value == 0;
    for (int lane = 0; lane < N; ++lane) is_zero &= a.by[lane] == 0;
    return is_zero;
}

/// Length of a vector of dual numbers. It is more specialised than the template in vec3.hpp, so that overload
/// resolution prefers it; its sqrt is the one above.
template <int N>
__attribute__((always_inline)) inline Dual<N> length(Vec3<Dual<N>> a) {
    return sqrt(dot(a, a));
}

/// Returns the values of a vector's components, without derivatives.
template <int N>
__attribute__((always_inline)) inline Vec3d value(const Vec3<Dual<N>>& v) {
    return {v.x.value, v.y.value, v.z.value};
}

}  // namespace REALCAM_NAMESPACE

template <int N>
struct std::numeric_limits<realcam::Dual<N>> : std::numeric_limits<double> {};
