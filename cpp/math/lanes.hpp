#pragma once
#include <cstddef>

#include "vec3.hpp"

// Arrays of lanes: code on blocks of N rays is written as loops over lanes, which compilers turn into vector
// instructions. A GPU thread uses N = 1.

namespace REALCAM_NAMESPACE {

/// Array of N lanes aligned to a cache line, for vector loads. A GPU thread has one lane, which must not be
/// over-aligned: the compiler would keep it in memory instead of registers.
template <class T, int N>
struct AlignedLanes {
    using type[[gnu::aligned(N > 1 ? 64 : alignof(T))]] = T[N];
};

/// Array of N lanes. Its alignment is set in a class, because clang forgets the alignment of an alias template.
template <class T, int N>
using Lanes = typename AlignedLanes<T, N>::type;

/// Returns `count`, at most N, rounded up to a multiple of the lanes of the widest vector register: a loop over that
/// many lanes needs no scalar remainder loop.
template <int N>
REALCAM_INLINE constexpr int whole_vectors(int count) {
    constexpr int kWidest = 16;  // floats of AVX-512
    static_assert(N % kWidest == 0);
    return (count + kWidest - 1) & -kWidest;
}

/// N vectors in structure-of-arrays form, so that a vector register loads adjacent values. A GPU thread uses N = 1, and
/// the arrays become registers.
template <class T, int N>
struct Vec3Lanes {
    Lanes<T, N> x, y, z;

    REALCAM_INLINE Vec3<T> operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
    REALCAM_INLINE void set(int lane, Vec3<T> v) {
        x[lane] = v.x;
        y[lane] = v.y;
        z[lane] = v.z;
    }
};

/// N two-component vectors in structure-of-arrays form.
template <class T, int N>
struct Vec2Lanes {
    Lanes<T, N> x, y;

    REALCAM_INLINE Vec2<T> operator[](int lane) const { return {x[lane], y[lane]}; }
    REALCAM_INLINE void set(int lane, Vec2<T> v) {
        x[lane] = v.x;
        y[lane] = v.y;
    }
};

/// Returns a if the condition holds, else b; both are always computed, so that a lane loop stays free of branches.
template <class T>
REALCAM_INLINE constexpr T select(bool condition, T a, T b) {
    return condition ? a : b;
}
/// Same for the components of vectors.
template <class T>
REALCAM_INLINE constexpr Vec3<T> select(bool condition, Vec3<T> a, Vec3<T> b) {
    return {condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z};
}

/// Returns the larger of v and `least`; `least` if v is NaN.
REALCAM_INLINE constexpr float at_least(float v, float least) {
    return select(v > least, v, least);
}

}  // namespace REALCAM_NAMESPACE
