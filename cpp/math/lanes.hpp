#pragma once
#include <cstddef>

#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// The alignment is that of a cache line, which vector loads want. A GPU thread has one lane, which a compiler
/// keeps in registers only where it need not lie in memory at such an address.
template <class T, int N>
struct AlignedLanes {
    using type[[gnu::aligned(N > 1 ? 64 : alignof(T))]] = T[N];
};

/// An array of N lanes. It is aligned by way of a class, because clang forgets the alignment of an alias template.
template <class T, int N>
using Lanes = typename AlignedLanes<T, N>::type;

/// The first `count` of N lanes, and those beside them that a vector register holds too: a loop to this number needs no
/// scalar code for what is left over.
template <int N>
REALCAM_INLINE constexpr int whole_vectors(int count) {
    constexpr int kWidest = 16;  // floats of AVX-512
    static_assert(N % kWidest == 0);
    return (count + kWidest - 1) & -kWidest;
}

/// N vectors in structure-of-arrays form: what one vector register loads lies side by side.
/// A GPU thread uses N = 1, and the arrays become registers.
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

/// The same for pairs.
template <class T, int N>
struct Vec2Lanes {
    Lanes<T, N> x, y;

    REALCAM_INLINE Vec2<T> operator[](int lane) const { return {x[lane], y[lane]}; }
    REALCAM_INLINE void set(int lane, Vec2<T> v) {
        x[lane] = v.x;
        y[lane] = v.y;
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

/// NaN becomes the least.
REALCAM_INLINE constexpr float at_least(float v, float least) {
    return select(v > least, v, least);
}

}  // namespace REALCAM_NAMESPACE
