#pragma once
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

// Energy that single scattering (one reflection or transmission by a microfacet) loses at a rough dielectric interface,
// from tables (tools/make_loss_tables.py). `critical` is the cosine of the critical angle; it stands for the ratio of
// the two refractive indices.

enum class BorderSide : int { outside, inside };  ///< the side of the lower and of the higher refractive index

/// Lowest refractive index of the tables: that of the smallest tabulated cosine of the critical angle.
inline constexpr float kLeastRoughIndex = 1.0482848f;

namespace border_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::row_of;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kBorderLayers = REALCAM_BORDER_LAYERS, kBorderRows = REALCAM_BORDER_ROWS,
                     kBorderColumns = REALCAM_BORDER_COLUMNS, kBorderMeanRows = REALCAM_BORDER_MEAN_ROWS;

REALCAM_INLINE TablePosition layer_of(float critical) {
    constexpr float kLeast = REALCAM_BORDER_LEAST_CRITICAL, kMost = REALCAM_BORDER_MOST_CRITICAL;
    return table_position((critical - kLeast) / (kMost - kLeast), kBorderLayers);
}

}  // namespace border_loss_detail

/// Loss (1 - directional albedo) of single scattering at the cosine of the angle of incidence. `found`: the directional
/// albedo of perfectly reflecting facets with single scattering, ggx_albedo(cosine, alpha).all.
REALCAM_HD inline float border_loss(BorderSide side, float cosine, float alpha, float critical, float found) {
    using namespace border_loss_detail;
    static constexpr float kLoss[] = {REALCAM_BORDER_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * 2 * kBorderLayers * kBorderRows * kBorderColumns);
    const TablePosition layer = layer_of(critical), row = row_of(alpha, kBorderRows),
                        column = table_position(std::sqrt(cosine), kBorderColumns);
    const float* upper = kLoss + (static_cast<int>(side) * kBorderLayers + layer.index) * kBorderRows * kBorderColumns;
    const float factor =
        between(read_table(upper, row, column, kBorderColumns),
                read_table(upper + kBorderRows * kBorderColumns, row, column, kBorderColumns), layer.fraction);
    const float loss = factor * (1.0f - found + 0.5f * alpha);
    return loss < 1.0f ? loss : 1.0f;
}

/// Cosine-weighted mean of border_loss over the hemisphere.
REALCAM_HD inline float border_mean_loss(BorderSide side, float alpha, float critical) {
    using namespace border_loss_detail;
    static constexpr float kLoss[] = {REALCAM_BORDER_MEAN_LOSS};  // divided by alpha^2
    static_assert(sizeof kLoss == sizeof(float) * 2 * kBorderLayers * kBorderMeanRows);
    const float* table = kLoss + static_cast<int>(side) * kBorderLayers * kBorderMeanRows;
    return alpha * alpha * read_table(table, layer_of(critical), row_of(alpha, kBorderMeanRows), kBorderMeanRows);
}

/// Dielectric interface that reflects and transmits: smooth, or rough by GGX microfacets (Walter et al. 2007). In local
/// coordinates, with `eye` above the surface. Radiance is that in the medium in question: it grows by the index squared
/// on entering a medium. The energy that single scattering loses returns in a lobe on each side (after Kulla and Conty
/// 2017). Multiply scattered light has lost the memory of its origin: it is divided between the two sides in a fixed
/// ratio, whatever the eye's side, which makes the lobes reciprocal.
struct DielectricBorder {
    float weight = 0;  ///< multiplies the whole lobe; 0: no border
    Color filter = {1, 1, 1};  ///< multiplies transmitted light
    float eta = 1;  ///< index below over index above
    float alpha = 0;  ///< GGX alpha; below kSmoothAlpha, or for an index near 1, the border is smooth
    float fixed_reflectance = -1;  ///< reflectance at any angle; negative: by the Fresnel equations
    bool is_thin = false;  ///< thin film: transmitted light is not refracted
    float found_at_eye = 1;  ///< directional albedo of single scattering for the eye's direction
    float below_share = 0.5f;  ///< share of the multiple-scattering energy that leaves below
    float lost = 0;  ///< mean loss of single scattering, summed over both sides, each weighted by its index squared
    float critical = 0;  ///< cosine of the critical angle

    REALCAM_INLINE bool is_smooth() const { return alpha < kSmoothAlpha; }

    /// Must be called after eta and alpha have been set.
    REALCAM_HD void prepare(float eye_cosine) {
        const float index = eta > 1.0f ? eta : 1.0f / eta;
        // Near an index of 1 facets deflect light by less than three degrees, and not at all at an index of 1, where
        // single scattering would leave no undeflected light.
        if (!is_thin && index < kLeastRoughIndex) alpha = 0.0f;
        if (is_smooth()) return;
        critical = std::sqrt(1.0f - 1.0f / (index * index));
        const float above = mean_lost(false), below = eta * eta * mean_lost(true);
        lost = is_thin ? 2.0f * above : above + below;
        if (!is_thin && lost > 0.0f) below_share = below / lost;
        found_at_eye = 1.0f - lost_at(false, eye_cosine);
    }

    REALCAM_INLINE float reflectance(float cosine) const {
        const float fresnel = dielectric_fresnel(cosine, eta);
        if (is_thin) {
            // Sum of all interreflections between the two faces of a film.
            const float one = fixed_reflectance < 0.0f ? fresnel : fixed_reflectance;
            return fixed_reflectance < 0.0f ? 2.0f * one / (1.0f + one) : one;
        }
        return fixed_reflectance < 0.0f || fresnel >= 1.0f ? fresnel : fixed_reflectance;
    }

    /// Direction refracted at a facet with normal h; z is 0 for total reflection.
    REALCAM_INLINE Vec3f refracted(Vec3f eye, Vec3f h) const {
        const float cosine = dot(eye, h), sine2 = (1.0f - cosine * cosine) / (eta * eta);
        if (!(sine2 < 1.0f)) return {0, 0, 0};
        return (cosine / eta - std::sqrt(1.0f - sine2)) * h - (1.0f / eta) * eye;
    }

    /// Normal of the facet that reflects or refracts `eye` to `light`.
    REALCAM_INLINE Vec3f facet(Vec3f eye, Vec3f light) const {
        if (light.z > 0.0f) return normalized(eye + light);
        if (is_thin) return normalized(eye + Vec3f{light.x, light.y, -light.z});
        const Vec3f h = normalized(eye + eta * light);
        return h.z < 0.0f ? -h : h;
    }

    /// BSDF times cosine.
    REALCAM_INLINE Color eval(Vec3f eye, Vec3f light) const {
        if (is_smooth() || light.z == 0.0f) return {0, 0, 0};
        const float value = weight * (once(eye, light) + several(light.z));
        return light.z > 0.0f ? grey(value) : value * filter;
    }

    /// Density of sample(), per steradian.
    REALCAM_INLINE float pdf(Vec3f eye, Vec3f light) const {
        if (is_smooth() || light.z == 0.0f) return 0.0f;
        const float side = light.z > 0.0f ? 1.0f - below_share : below_share;
        return found_at_eye * pdf_once(eye, light) + (1.0f - found_at_eye) * side * (2.0f * kSpherePdf);
    }

    /// Samples a direction. `choice`: random number that chooses reflection or transmission. Weight and density are
    /// those of a smooth border; for a rough one use eval and pdf. Black if the light would hit other facets, a path
    /// that is not followed.
    REALCAM_INLINE BsdfSample sample(Vec3f eye, Vec2f u, float choice) const {
        if (u.x >= found_at_eye) {
            // Uniform over the hemisphere, not by cosine: on smooth surfaces energy is lost at grazing incidence.
            const float fresh = (u.x - found_at_eye) / (1.0f - found_at_eye);
            const Vec3f above = sample_sphere({fresh < 1.0f ? 0.5f * fresh : 0.5f, u.y});
            if (!(choice < below_share)) return {above, grey(1.0f), kDelta, false};
            return {{above.x, above.y, -above.z}, filter, kDelta, !is_thin};
        }
        const Vec3f h = is_smooth() ? Vec3f{0, 0, 1} : sample_ggx(eye, alpha, {u.x / found_at_eye, u.y});
        const float c = dot(eye, h), reflected = reflectance(c);
        constexpr Color kNone = {0, 0, 0};
        if (choice < reflected || is_thin) {
            const Vec3f mirrored = (2.0f * c) * h - eye;
            if (!(mirrored.z > 0.0f)) return {mirrored, kNone, 0.0f, false};
            if (choice < reflected) return {mirrored, grey(1.0f), kDelta, false};
            return {{mirrored.x, mirrored.y, -mirrored.z}, filter, kDelta, false};
        }
        const Vec3f below = refracted(eye, h);
        return {below, below.z < 0.0f ? (1.0f / (eta * eta)) * filter : kNone, kDelta, true};
    }

private:
    /// Single scattering: BSDF times cosine, without weight and filter.
    REALCAM_INLINE float once(Vec3f eye, Vec3f light) const {
        const Vec3f h = facet(eye, light);
        const float c = dot(eye, h);
        if (!(c > 0.0f)) return 0.0f;
        const float reflected = reflectance(c);
        const Vec3f upper = is_thin ? Vec3f{light.x, light.y, std::fabs(light.z)} : light;
        const float both = ggx_density(h, alpha) * ggx_visible_to_both(eye, upper, alpha);
        if (is_thin || light.z > 0.0f) return both * (light.z > 0.0f ? reflected : 1.0f - reflected) / (4.0f * eye.z);
        const float d = dot(light, h), denominator = c + eta * d;
        if (!(d < 0.0f) || denominator == 0.0f) return 0.0f;
        return (1.0f - reflected) * both * c * -d / (eye.z * denominator * denominator);
    }

    REALCAM_INLINE float pdf_once(Vec3f eye, Vec3f light) const {
        const Vec3f h = facet(eye, light);
        const float c = dot(eye, h);
        if (!(c > 0.0f)) return 0.0f;
        const float reflected = reflectance(c), facets = ggx_pdf(eye, h, alpha);
        if (is_thin || light.z > 0.0f) return (light.z > 0.0f ? reflected : 1.0f - reflected) * facets / (4.0f * c);
        const float d = dot(light, h), denominator = c + eta * d;
        if (!(d < 0.0f) || denominator == 0.0f) return 0.0f;
        return (1.0f - reflected) * facets * eta * eta * -d / (denominator * denominator);
    }

    /// Multiple scattering: BSDF times cosine, without weight and filter. Below the surface the energy grows by the
    /// index squared, and radiance shrinks by the same factor towards the eye.
    REALCAM_INLINE float several(float light_z) const {
        if (!(lost > 1e-6f)) return 0.0f;
        const float cosine = std::fabs(light_z);
        return (1.0f - found_at_eye) * lost_at(light_z < 0.0f, cosine) * 0.3183098862f * cosine / lost;
    }

    REALCAM_INLINE BorderSide side_of(bool is_below) const {
        return (eta > 1.0f) == is_below ? BorderSide::inside : BorderSide::outside;
    }
    REALCAM_INLINE float lost_at(bool is_below, float cosine) const {
        const float found = ggx_albedo(cosine, alpha).all;
        return is_thin ? 1.0f - found : border_loss(side_of(is_below), cosine, alpha, critical, found);
    }
    REALCAM_INLINE float mean_lost(bool is_below) const {
        return is_thin ? 1.0f - ggx_mean_albedo(alpha).all : border_mean_loss(side_of(is_below), alpha, critical);
    }
};

}  // namespace REALCAM_NAMESPACE
