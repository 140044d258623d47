#pragma once
// Macros and functions that depend on the compiler and the processor. This is the only file of the core that tests
// __CUDACC__.

#include <bit>
#include <cstdint>

#include <cmath>

#if defined(__CUDACC__)
#define REALCAM_HD __host__ __device__
#else
#define REALCAM_HD
#endif

// Small functions that run once per ray and surface. Inlining is part of their contract: a call inside a lane loop
// would stop the loop from becoming vector code.
#if defined(__GNUC__)
#define REALCAM_INLINE REALCAM_HD inline __attribute__((always_inline))
#else
#define REALCAM_INLINE REALCAM_HD inline
#endif

// Large functions that a GPU kernel contains once, however often it calls them: its instruction cache is full, and a
// call takes less time than waiting for more code. With REALCAM_GPU_CALL, a CPU's compiler decides about inlining.
#if defined(__CUDACC__)
#define REALCAM_ONE_COPY REALCAM_HD inline __noinline__
#define REALCAM_GPU_CALL REALCAM_ONE_COPY
#else
#define REALCAM_ONE_COPY REALCAM_INLINE
#define REALCAM_GPU_CALL inline
#endif

// Written before a loop over the lanes of a block: no lane reads what another lane writes.
#if defined(__CUDA_ARCH__) || !defined(__GNUC__) || defined(__clang__)
#define REALCAM_LANES
#else
#define REALCAM_LANES _Pragma("GCC ivdep")
#endif

// Written before a loop with a constant number of iterations: arrays that it indexes can then live in registers.
#if defined(__CUDA_ARCH__)
#define REALCAM_UNROLL _Pragma("unroll")
#define REALCAM_NO_UNROLL _Pragma("unroll 1")
#elif defined(__CUDACC__)
#define REALCAM_UNROLL
#define REALCAM_NO_UNROLL
#else
#define REALCAM_UNROLL _Pragma("GCC unroll 16")
#define REALCAM_NO_UNROLL
#endif

// A translation unit that is built for one instruction set defines REALCAM_ISA (v2, v3, v4). The whole core then lives
// in an inline namespace of that name, so that no inline function compiled with AVX-512 can be the copy that the linker
// keeps for a machine without it.
#if defined(REALCAM_ISA)
#define REALCAM_NAMESPACE realcam::inline REALCAM_ISA
#else
#define REALCAM_NAMESPACE realcam
#endif

namespace REALCAM_NAMESPACE {

// Square root and quotient, correctly rounded for arguments and results between 2^-100 and 2^100, on a GPU too. There
// the built-in ones handle all other numbers as well, with a test, a branch and a call: a sixth of the instructions of
// a ray. These take the same steps without them: an approximation, and a Newton step on the residual. Outside that
// range they are inaccurate, and infinity becomes NaN.

/// Returns the square root, or 0 (on a GPU about 2^-51) for negative numbers and NaN, which the caller must test for.
REALCAM_INLINE float sqrt_or_zero(float v) {
#if defined(__CUDA_ARCH__)
    v = fmaxf(v, 0x1p-101f);
    float inverse;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(v));
    const float root = v * inverse;
    return fmaf(fmaf(-root, root, v), 0.5f * inverse, root);
#else
    return std::sqrt(v > 0.0f ? v : 0.0f);
#endif
}
REALCAM_INLINE double sqrt_or_zero(double v) {
    return std::sqrt(v > 0.0 ? v : 0.0);
}

/// Returns the quotient of two numbers.
REALCAM_INLINE float quotient(float numerator, float denominator) {
#if defined(__CUDA_ARCH__)
    float inverse;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(denominator));
    inverse = fmaf(fmaf(-denominator, inverse, 1.0f), inverse, inverse);
    const float rough = numerator * inverse;
    return fmaf(fmaf(-denominator, rough, numerator), inverse, rough);
#else
    return numerator / denominator;
#endif
}
REALCAM_INLINE double quotient(double numerator, double denominator) {
    return numerator / denominator;
}

/// Returns the 32 bits in reverse order.
REALCAM_INLINE unsigned reverse_bits(unsigned v) {
#if defined(__CUDA_ARCH__)
    return __brev(v);
#else
    v = ((v & 0x55555555u) << 1) | ((v >> 1) & 0x55555555u);
    v = ((v & 0x33333333u) << 2) | ((v >> 2) & 0x33333333u);
    v = ((v & 0x0f0f0f0fu) << 4) | ((v >> 4) & 0x0f0f0f0fu);
    return __builtin_bswap32(v);
#endif
}

/// Returns the number of bits that are set.
REALCAM_INLINE unsigned count_bits(unsigned v) {
#if defined(__CUDA_ARCH__)
    return static_cast<unsigned>(__popc(static_cast<int>(v)));
#else
    return static_cast<unsigned>(std::popcount(v));
#endif
}

/// True in code compiled for a GPU.
#if defined(__CUDA_ARCH__)
inline constexpr bool kIsDeviceCode = true;
#else
inline constexpr bool kIsDeviceCode = false;
#endif

/// Sets bits of the word `*to`. On a GPU, but not on a CPU, other threads may do so at the same time.
REALCAM_INLINE void add_bits(unsigned* to, unsigned bits) {
#if defined(__CUDA_ARCH__)
    atomicOr(to, bits);
#else
    *to |= bits;
#endif
}

/// Returns a value from memory that is not written while the kernel runs; a GPU loads 128 bits at a time.
template <class T>
REALCAM_INLINE T load_constant(const T* from) {
    static_assert(sizeof(T) % 16 == 0 && alignof(T) == 16);
#if defined(__CUDA_ARCH__)
    struct Quads {
        uint4 quad[sizeof(T) / 16];
    } quads;
#pragma unroll
    for (unsigned i = 0; i < sizeof(T) / 16; ++i) quads.quad[i] = __ldg(reinterpret_cast<const uint4*>(from) + i);
    return __builtin_bit_cast(T, quads);
#else
    return *from;
#endif
}

/// Bits of the float 32768.
inline constexpr std::uint32_t kBitsOf32768 = 0x47000000u;

/// Returns 32768 + byte `index` (0: the lowest) of a word, exactly: the byte is inserted into the mantissa of the
/// float. On a GPU this is one permutation of bytes instead of a shift, a mask and a conversion, for which it has few
/// units. `bits_of_32768` must be kBitsOf32768.
REALCAM_INLINE float byte_above_32768(std::uint32_t word, unsigned index, std::uint32_t bits_of_32768) {
#if defined(__CUDA_ARCH__)
    return __uint_as_float(__byte_perm(word, bits_of_32768, 0x7604u | index << 4));
#else
    return std::bit_cast<float>(bits_of_32768 | (word >> (8 * index) & 0xffu) << 8);
#endif
}

// Positive floats have the same order as their bits, read as integers. Hopper GPUs compute the maximum of three
// integers and 0, or the minimum of three, in one instruction.

/// Returns the largest of three floats and 0. The floats are not NaN.
REALCAM_INLINE float largest_or_zero(float a, float b, float c) {
#if defined(__CUDA_ARCH__)
    return __int_as_float(__vimax3_s32_relu(__float_as_int(a), __float_as_int(b), __float_as_int(c)));
#else
    const float ab = a > b ? a : b, abc = ab > c ? ab : c;
    return abc > 0.0f ? abc : 0.0f;
#endif
}

/// Returns the smallest of four floats, which are not NaN. If any are negative, returns one of the negative ones.
REALCAM_INLINE float smallest_if_positive(float a, float b, float c, float d) {
#if defined(__CUDA_ARCH__)
    const int abc = __vimin3_s32(__float_as_int(a), __float_as_int(b), __float_as_int(c));
    const int bits = __float_as_int(d);
    return __int_as_float(abc < bits ? abc : bits);
#else
    const float ab = a < b ? a : b, cd = c < d ? c : d;
    return ab < cd ? ab : cd;
#endif
}

/// Returns `bits` shifted left by one, with the sign bit of v (1 if negative) as the lowest bit.
REALCAM_INLINE unsigned append_sign(unsigned bits, float v) {
#if defined(__CUDA_ARCH__)
    return __funnelshift_l(__float_as_uint(v), bits, 1);
#else
    return bits << 1 | std::bit_cast<std::uint32_t>(v) >> 31;
#endif
}

}  // namespace REALCAM_NAMESPACE
