#pragma once
// What the compiler and the chip decide. This is the one file of the core that looks at __CUDACC__.

#if defined(__CUDACC__)
#define REALCAM_HD __host__ __device__
#else
#define REALCAM_HD
#endif

// Small functions that run once per ray and surface. Inlining is part of their contract: a call inside a lane
// loop would stop the loop from becoming vector code.
#if defined(__GNUC__)
#define REALCAM_INLINE REALCAM_HD inline __attribute__((always_inline))
#else
#define REALCAM_INLINE REALCAM_HD inline
#endif

// Written before a loop over the lanes of a block: no lane reads what another lane writes.
#if defined(__CUDA_ARCH__) || !defined(__GNUC__) || defined(__clang__)
#define REALCAM_LANES
#else
#define REALCAM_LANES _Pragma("GCC ivdep")
#endif

// A translation unit that is built for one instruction set defines REALCAM_ISA (v2, v3, v4). The whole core then
// lives in an inline namespace of that name, so that no inline function compiled with AVX-512 can be the copy that
// the linker keeps for a machine without it.
#if defined(REALCAM_ISA)
#define REALCAM_NAMESPACE realcam::inline REALCAM_ISA
#else
#define REALCAM_NAMESPACE realcam
#endif

namespace REALCAM_NAMESPACE {

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

}  // namespace REALCAM_NAMESPACE
