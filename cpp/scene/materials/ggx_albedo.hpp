#pragma once
#include <bit>
#include <cstdint>

#include "../../math/color.hpp"
#include "../../math/lanes.hpp"
#include "../../math/sincos.hpp"
#include "ggx_tables.hpp"

namespace REALCAM_NAMESPACE {

// Microfacet distribution of Trowbridge and Reitz (GGX; Walter et al. 2007), in a frame whose z axis is the surface
// normal. `alpha`: root mean square slope, which is glTF's roughness squared.

/// Below this alpha a lobe is narrower than float directions resolve, and is treated as a mirror.
inline constexpr float kSmoothAlpha = 1e-3f;

/// Normal distribution D(h), per steradian.
REALCAM_INLINE float ggx_density(Vec3f h, float alpha) {
    // h.z^2 (alpha^2 - 1) + 1, without its cancellation at h.z = 1.
    const float a2 = alpha * alpha, k = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
    return a2 / (3.141592654f * k * k);
}

/// Smith's Lambda function.
REALCAM_INLINE float ggx_lambda(Vec3f w, float alpha) {
    const float tangent2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * tangent2) - 1.0f);
}

/// Smith masking function G1.
REALCAM_INLINE float ggx_masking(Vec3f w, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(w, alpha));
}

/// Height-correlated masking-shadowing function G2 (Heitz 2014). For directions on different sides of the surface,
/// where Heitz derives a Beta function of the Lambdas, the same form is used.
REALCAM_INLINE float ggx_masking_shadowing(Vec3f a, Vec3f b, float alpha) {
    return 1.0f / (1.0f + ggx_lambda(a, alpha) + ggx_lambda(b, alpha));
}

/// Samples a facet normal that is visible from direction w, w.z > 0 (Dupuy and Benyoub 2023).
REALCAM_INLINE Vec3f sample_ggx(Vec3f w, float alpha, Vec2f u) {
    const Vec3f stretched = normalized(Vec3f{alpha * w.x, alpha * w.y, w.z});
    const Vec2f azimuth = cos_sin_of_turn(u.y);
    const float z = (1.0f - u.x) * (1.0f + stretched.z) - stretched.z;
    const float radius = sqrt_or_zero(1.0f - z * z);
    const Vec3f h = Vec3f{radius * azimuth.x, radius * azimuth.y, z} + stretched;
    return normalized(Vec3f{alpha * h.x, alpha * h.y, h.z > 1e-6f ? h.z : 1e-6f});
}

/// Density of sample_ggx, per steradian of facet normals (not of reflected directions).
REALCAM_INLINE float ggx_pdf(Vec3f w, Vec3f h, float alpha) {
    const float cosine = dot(w, h);
    return cosine > 0.0f ? ggx_masking(w, alpha) * ggx_density(h, alpha) * cosine / w.z : 0.0f;
}

// Directional albedo of single scattering by GGX microfacets, from tables (tools/make_ggx_tables.py); its complement is
// the energy of multiple scattering (Kulla and Conty 2017).

/// Directional albedo of single scattering, split so that Schlick's term can be applied to it: with f0 + (f90 - f0)
/// (1 - cosine)^5 the albedo is f0 (all - grazing) + f90 grazing.
struct GgxAlbedo {
    float all;  ///< albedo for a Fresnel term of 1
    float grazing;  ///< albedo for the Fresnel term (1 - cosine)^5
};

namespace ggx_albedo_detail {

inline constexpr int kRows = REALCAM_GGX_ROWS, kColumns = REALCAM_GGX_COLUMNS;

/// Position in a table for linear interpolation: between the entries `index` and index + 1.
struct TablePosition {
    int index;
    float fraction;  ///< 0 to 1
};

/// Position, 0 to 1 and clamped to that, in a table of `count` evenly spaced entries.
REALCAM_INLINE TablePosition table_position(float position, int count) {
    const float scaled = position * static_cast<float>(count - 1);
    const int index = static_cast<int>(scaled);
    // Two selects in sequence, of integers: otherwise gcc emits branches and does not vectorise the loop.
    const int not_below = select(index > 0, index, 0), clamped = select(not_below < count - 2, not_below, count - 2);
    const float fraction = scaled - static_cast<float>(clamped);
    return {clamped, select(fraction < 0.0f, 0.0f, select(fraction > 1.0f, 1.0f, fraction))};
}

/// Table row: the square root of alpha, from that of kSmoothAlpha to 1.
REALCAM_INLINE TablePosition row_of(float alpha, int rows = kRows) {
    constexpr float kSmoothest = 0.0316227766f;  // square root of kSmoothAlpha
    return table_position((std::sqrt(alpha) - kSmoothest) / (1.0f - kSmoothest), rows);
}

/// Cube root of a number from 0 to 1, with a relative error of 2e-6. It uses Newton's steps from a third of the
/// exponent, because std::cbrt takes 6% of the render time of a picture with glossy surfaces.
REALCAM_INLINE float cube_root(float x) {
    // The constant is two thirds of the bits of 1.0f, less a correction that balances the error of the approximation.
    float y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3 + 0x2a514067u);
    for (int i = 0; i < 2; ++i) y = 0.333333333f * (2.0f * y + x / (y * y));
    return y;
}

/// Table column: the cosine on the surface stretched to alpha 1, to the power 2/3.
REALCAM_INLINE TablePosition column_of(float cosine, float alpha) {
    const float sine2 = 1.0f - cosine * cosine;
    const float root = cube_root(cosine / std::sqrt(cosine * cosine + alpha * alpha * (sine2 > 0.0f ? sine2 : 0.0f)));
    return table_position(root * root, kColumns);
}

/// Linear interpolation.
REALCAM_INLINE float between(float a, float b, float fraction) {
    return a + fraction * (b - a);
}

/// Bilinear interpolation in a table of this number of columns.
REALCAM_INLINE float read_table(const float* table, TablePosition row, TablePosition column, int columns = kColumns) {
    const int upper = row.index * columns + column.index, lower = upper + columns;
    return between(between(table[upper], table[upper + 1], column.fraction),
                   between(table[lower], table[lower + 1], column.fraction), row.fraction);
}

}  // namespace ggx_albedo_detail

/// Directional albedo at a cosine. Inlined on all platforms, for loops that must vectorise.
REALCAM_INLINE GgxAlbedo inlined_ggx_albedo(float cosine, float alpha) {
    using namespace ggx_albedo_detail;
    static constexpr float kAll[] = {REALCAM_GGX_ALBEDO};
    static constexpr float kGrazingOfAll[] = {REALCAM_GGX_SCHLICK};  // grazing / all
    static_assert(sizeof kAll == sizeof(float) * kRows * kColumns && sizeof kGrazingOfAll == sizeof kAll);
    const TablePosition row = row_of(alpha);
    const float all = read_table(kAll, row, column_of(cosine, alpha));
    return {all, all * read_table(kGrazingOfAll, row, table_position(std::sqrt(cosine), kColumns))};
}

/// Directional albedo at a cosine, for all other callers.
REALCAM_GPU_CALL GgxAlbedo ggx_albedo(float cosine, float alpha) {
    return inlined_ggx_albedo(cosine, alpha);
}

/// Cosine-weighted mean of the albedo over the hemisphere. Inlined on all platforms, for loops that must vectorise.
REALCAM_INLINE GgxAlbedo inlined_ggx_mean_albedo(float alpha) {
    using namespace ggx_albedo_detail;
    static constexpr float kLoss[] = {REALCAM_GGX_MEAN_LOSS};  // divided by alpha^2
    static constexpr float kGrazing[] = {REALCAM_GGX_MEAN_SCHLICK};
    const TablePosition row = row_of(alpha);
    const int i = row.index;
    return {1.0f - alpha * alpha * between(kLoss[i], kLoss[i + 1], row.fraction),
            between(kGrazing[i], kGrazing[i + 1], row.fraction)};
}

/// Cosine-weighted mean of the albedo, for all other callers.
REALCAM_GPU_CALL GgxAlbedo ggx_mean_albedo(float alpha) {
    return inlined_ggx_mean_albedo(alpha);
}

}  // namespace REALCAM_NAMESPACE
