#pragma once
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

// Energy that single scattering (one reflection or transmission by a microfacet) loses at a rough dielectric interface,
// from tables (tools/make_loss_tables.py). The tables are indexed by `critical`, the cosine of the critical angle,
// which is sqrt(1 - 1 / n^2) for a ratio n > 1 of the two refractive indices.

/// Side of the incident light: that of the lower (outside) or of the higher refractive index (inside).
enum class InterfaceSide : int { outside, inside };

/// Lowest refractive index of the tables: that of the smallest tabulated cosine of the critical angle.
inline constexpr float kMinRoughIndex = 1.0482848f;

namespace interface_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::row_of;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kInterfaceLayers = REALCAM_INTERFACE_LAYERS, kInterfaceRows = REALCAM_INTERFACE_ROWS,
                     kInterfaceColumns = REALCAM_INTERFACE_COLUMNS, kInterfaceMeanRows = REALCAM_INTERFACE_MEAN_ROWS;

/// Table layer of a cosine of the critical angle.
REALCAM_INLINE TablePosition layer_of(float critical) {
    constexpr float kMinCritical = REALCAM_INTERFACE_LEAST_CRITICAL, kMaxCritical = REALCAM_INTERFACE_MOST_CRITICAL;
    return table_position((critical - kMinCritical) / (kMaxCritical - kMinCritical), kInterfaceLayers);
}

}  // namespace interface_loss_detail

/// Loss (1 - directional albedo) of single scattering at the cosine of the angle of incidence. `reflector_albedo`: the
/// directional albedo of perfectly reflecting facets with single scattering, ggx_albedo(cosine, alpha).all. The table
/// holds the loss relative to a function of it that has the same sharp features.
REALCAM_HD inline float interface_loss(InterfaceSide side, float cosine, float alpha, float critical,
                                       float reflector_albedo) {
    using namespace interface_loss_detail;
    static constexpr float kLoss[] = {REALCAM_INTERFACE_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * 2 * kInterfaceLayers * kInterfaceRows * kInterfaceColumns);
    const TablePosition layer = layer_of(critical), row = row_of(alpha, kInterfaceRows),
                        column = table_position(std::sqrt(cosine), kInterfaceColumns);
    const float* upper =
        kLoss + (static_cast<int>(side) * kInterfaceLayers + layer.index) * kInterfaceRows * kInterfaceColumns;
    const float factor =
        between(read_table(upper, row, column, kInterfaceColumns),
                read_table(upper + kInterfaceRows * kInterfaceColumns, row, column, kInterfaceColumns), layer.fraction);
    const float loss = factor * (1.0f - reflector_albedo + 0.5f * alpha);
    return loss < 1.0f ? loss : 1.0f;
}

/// Cosine-weighted mean of interface_loss over the hemisphere.
REALCAM_HD inline float interface_mean_loss(InterfaceSide side, float alpha, float critical) {
    using namespace interface_loss_detail;
    static constexpr float kLoss[] = {REALCAM_INTERFACE_MEAN_LOSS};  // divided by alpha^2
    static_assert(sizeof kLoss == sizeof(float) * 2 * kInterfaceLayers * kInterfaceMeanRows);
    const float* table = kLoss + static_cast<int>(side) * kInterfaceLayers * kInterfaceMeanRows;
    return alpha * alpha * read_table(table, layer_of(critical), row_of(alpha, kInterfaceMeanRows), kInterfaceMeanRows);
}

/// Dielectric interface that reflects and transmits: smooth, or rough by GGX microfacets (Walter et al. 2007).
/// Directions are local, unit, and point away from the surface; `eye`, the direction to the eye, is above it. Radiance
/// grows by the index squared on entering a medium (it is not divided by the index squared). The energy that single
/// scattering loses returns in a lobe on each side (after Kulla and Conty 2017). Multiply scattered light is
/// distributed over the two sides in a fixed ratio, independent of the eye's side, which makes the lobes reciprocal.
struct DielectricInterface {
    float weight = 0;  ///< multiplies the whole lobe; 0: no interface
    Color filter = {1, 1, 1};  ///< multiplies transmitted light
    float eta = 1;  ///< index below over index above
    float alpha = 0;  ///< GGX alpha; below kSmoothAlpha, or for an index near 1, the interface is smooth
    float fixed_reflectance = -1;  ///< reflectance at any angle; negative: by the Fresnel equations
    bool is_thin = false;  ///< thin film: transmitted light is not refracted
    float albedo_at_eye = 1;  ///< directional albedo of single scattering for the eye's direction
    float below_fraction = 0.5f;  ///< fraction of the multiple-scattering energy that leaves below
    /// Mean loss of single scattering, summed over both sides, each weighted by its index squared.
    float total_loss = 0;
    float critical = 0;  ///< cosine of the critical angle

    REALCAM_INLINE bool is_smooth() const { return alpha < kSmoothAlpha; }

    /// Sets the members from albedo_at_eye on. Must be called after eta and alpha have been set.
    REALCAM_HD void prepare(float eye_cosine) {
        const float index = eta > 1.0f ? eta : 1.0f / eta;
        // Near an index of 1 facets deflect light by less than three degrees, and not at all at an index of 1, where
        // single scattering would leave no undeflected light.
        if (!is_thin && index < kMinRoughIndex) alpha = 0.0f;
        if (is_smooth()) return;
        critical = std::sqrt(1.0f - 1.0f / (index * index));
        const float above = mean_loss(false), below = eta * eta * mean_loss(true);
        total_loss = is_thin ? 2.0f * above : above + below;
        if (!is_thin && total_loss > 0.0f) below_fraction = below / total_loss;
        albedo_at_eye = 1.0f - loss_at(false, eye_cosine);
    }

    /// Reflectance of a facet at the cosine of the angle of incidence.
    REALCAM_INLINE float reflectance(float cosine) const {
        const float fresnel = dielectric_fresnel(cosine, eta);
        if (is_thin) {
            // Sum of all interreflections between the two faces of a film.
            return fixed_reflectance < 0.0f ? 2.0f * fresnel / (1.0f + fresnel) : fixed_reflectance;
        }
        return fixed_reflectance < 0.0f || fresnel >= 1.0f ? fresnel : fixed_reflectance;
    }

    /// Direction refracted at a facet with normal h; the zero vector for total reflection.
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
        const float value = weight * (single_scattering(eye, light) + multiple_scattering(light.z));
        return light.z > 0.0f ? grey(value) : value * filter;
    }

    /// Density of sample(), per steradian.
    REALCAM_INLINE float pdf(Vec3f eye, Vec3f light) const {
        if (is_smooth() || light.z == 0.0f) return 0.0f;
        const float side = light.z > 0.0f ? 1.0f - below_fraction : below_fraction;
        return albedo_at_eye * single_scattering_pdf(eye, light) + (1.0f - albedo_at_eye) * side * (2.0f * kSpherePdf);
    }

    /// Samples a direction. `choice`: random number that chooses reflection or transmission. Weight and density are
    /// those of a smooth interface; for a rough one use eval and pdf. Black if the direction leads into the surface,
    /// where light would hit other facets: single scattering ends there.
    REALCAM_INLINE BsdfSample sample(Vec3f eye, Vec2f u, float choice) const {
        if (u.x >= albedo_at_eye) {
            // Uniform over the hemisphere, not by cosine: on smooth surfaces energy is lost at grazing incidence.
            const float rescaled = (u.x - albedo_at_eye) / (1.0f - albedo_at_eye);
            const Vec3f above = sample_sphere({rescaled < 1.0f ? 0.5f * rescaled : 0.5f, u.y});
            if (!(choice < below_fraction)) return {above, grey(1.0f), kDelta, false};
            return {{above.x, above.y, -above.z}, filter, kDelta, !is_thin};
        }
        const Vec3f h = is_smooth() ? Vec3f{0, 0, 1} : sample_ggx(eye, alpha, {u.x / albedo_at_eye, u.y});
        const float c = dot(eye, h), reflected = reflectance(c);
        constexpr Color kBlack = {0, 0, 0};
        if (choice < reflected || is_thin) {
            const Vec3f mirrored = (2.0f * c) * h - eye;
            if (!(mirrored.z > 0.0f)) return {mirrored, kBlack, 0.0f, false};
            if (choice < reflected) return {mirrored, grey(1.0f), kDelta, false};
            return {{mirrored.x, mirrored.y, -mirrored.z}, filter, kDelta, false};
        }
        const Vec3f below = refracted(eye, h);
        return {below, below.z < 0.0f ? (1.0f / (eta * eta)) * filter : kBlack, kDelta, true};
    }

private:
    /// Single scattering: BSDF times cosine, without weight and filter.
    REALCAM_INLINE float single_scattering(Vec3f eye, Vec3f light) const {
        const Vec3f h = facet(eye, light);
        const float c = dot(eye, h);
        if (!(c > 0.0f)) return 0.0f;
        const float reflected = reflectance(c);
        const Vec3f upper = is_thin ? Vec3f{light.x, light.y, std::fabs(light.z)} : light;
        const float visible_facets = ggx_density(h, alpha) * ggx_masking_shadowing(eye, upper, alpha);
        if (is_thin || light.z > 0.0f)
            return visible_facets * (light.z > 0.0f ? reflected : 1.0f - reflected) / (4.0f * eye.z);
        const float d = dot(light, h), denominator = c + eta * d;
        if (!(d < 0.0f) || denominator == 0.0f) return 0.0f;
        return (1.0f - reflected) * visible_facets * c * -d / (eye.z * denominator * denominator);
    }

    /// Density of a direction sampled by single scattering, per steradian.
    REALCAM_INLINE float single_scattering_pdf(Vec3f eye, Vec3f light) const {
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
    REALCAM_INLINE float multiple_scattering(float light_z) const {
        if (!(total_loss > 1e-6f)) return 0.0f;
        const float cosine = std::fabs(light_z);
        return (1.0f - albedo_at_eye) * loss_at(light_z < 0.0f, cosine) * kInvPi * cosine / total_loss;
    }

    /// Side of the table for directions above or below the surface.
    REALCAM_INLINE InterfaceSide side_of(bool is_below) const {
        return (eta > 1.0f) == is_below ? InterfaceSide::inside : InterfaceSide::outside;
    }
    /// Loss of single scattering for a direction above or below the surface.
    REALCAM_INLINE float loss_at(bool is_below, float cosine) const {
        const float reflector_albedo = ggx_albedo(cosine, alpha).all;
        return is_thin ? 1.0f - reflector_albedo
                       : interface_loss(side_of(is_below), cosine, alpha, critical, reflector_albedo);
    }
    /// Cosine-weighted mean of loss_at.
    REALCAM_INLINE float mean_loss(bool is_below) const {
        return is_thin ? 1.0f - ggx_mean_albedo(alpha).all : interface_mean_loss(side_of(is_below), alpha, critical);
    }
};

}  // namespace REALCAM_NAMESPACE
