#pragma once
#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// N vectors in structure-of-arrays form: what one vector register loads lies side by side.
/// A GPU thread uses N = 1, and the arrays become registers.
template <class T, int N>
struct Vec3Lanes {
    alignas(64) T x[N], y[N], z[N];

    REALCAM_INLINE Vec3<T> operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
    REALCAM_INLINE void set(int lane, Vec3<T> v) {
        x[lane] = v.x;
        y[lane] = v.y;
        z[lane] = v.z;
    }
};

/// a where the condition holds, else b; both are always computed, so that a lane loop stays free of branches.
template <class T>
REALCAM_INLINE constexpr T select(bool condition, T a, T b) {
    return condition ? a : b;
}
template <class T>
REALCAM_INLINE constexpr Vec3<T> select(bool condition, Vec3<T> a, Vec3<T> b) {
    return {condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z};
}

/// sqrt that gives 0 for negative numbers and NaN. The caller tests the argument itself.
template <class T>
REALCAM_INLINE T sqrt_or_zero(T v) {
    return std::sqrt(v > T(0) ? v : T(0));
}

}  // namespace REALCAM_NAMESPACE
