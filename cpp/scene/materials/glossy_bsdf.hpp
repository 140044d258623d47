#pragma once
#include "light_sample.hpp"
#include "make_bsdf.hpp"

namespace REALCAM_NAMESPACE {

/// Parameters of a GlossyBsdf: those of a material, evaluated at one point, that affect its lobes.
struct GlossySurface {
    Color base = {0, 0, 0};  ///< reflectance of the Lambertian lobe, or of a metal's facets at normal incidence
    Color f0 = {0, 0, 0};  ///< reflectance of a dielectric's facets at normal incidence
    float f90 = 0;  ///< reflectance of a dielectric's facets at grazing incidence
    float metallic = 0;  ///< metallic share of the surface, 0 to 1
    float alpha = 1;  ///< GGX alpha, at least kSmoothAlpha
};

/// True if GlossyBsdf can represent the material at a point.
REALCAM_INLINE bool is_glossy(const SurfacePoint& point) {
    const Material& m = *point.material;
    if (m.only_shadows || point.transmission > 0.0f) return false;
    if (m.model == MaterialModel::phong) return is_black(point.specular) && is_black(m.mirror);
    return !(point.clearcoat > 0.0f) && make_bsdf_detail::alpha_of(point.roughness) >= kSmoothAlpha;
}

/// Requires is_glossy(point).
REALCAM_INLINE GlossySurface glossy_surface(const SurfacePoint& point) {
    using namespace make_bsdf_detail;
    const Material& m = *point.material;
    if (m.model == MaterialModel::phong) return {point.diffuse, {0, 0, 0}, 0.0f, 0.0f, 1.0f};
    return {unit_range(point.diffuse), unit_range((point.specular_weight * normal_reflectance(m.ior)) * point.specular),
            point.specular_weight, unit_range(point.metallic), alpha_of(point.roughness)};
}

/// Lobe of a surface by which lights are chosen. `normal`: on the eye's side.
REALCAM_INLINE LightLobe light_lobe(const GlossySurface& surface, Vec3f normal, Vec3f to_eye) {
    const float cosine = dot(normal, to_eye), left = 1.0f - select(cosine > 0.0f, cosine, 0.0f),
                grazing = left * left * left * left * left;
    const float base = largest(surface.base), f0 = largest(surface.f0);
    const float dielectric = f0 + (surface.f90 - f0) * grazing, metal = base + (1.0f - base) * grazing;
    const float specular = dielectric + (metal - dielectric) * surface.metallic,
                diffuse = (1.0f - surface.metallic) * base;
    // A lobe about as broad as the Lambertian one favours the same lights and is not worth evaluating at each node of
    // the light tree.
    constexpr float kBroad = 0.5f;
    const bool is_used = (specular > 0.0f) & (surface.alpha < kBroad);
    return {to_eye, surface.alpha, select(is_used, specular / (specular + diffuse), 0.0f)};
}

/// Lobe of any surface point by which lights are chosen; without one, if GlossyBsdf cannot represent the material, they
/// are chosen by their illuminance.
REALCAM_INLINE LightLobe light_lobe(const SurfacePoint& point, Vec3f to_eye) {
    return is_glossy(point) ? light_lobe(glossy_surface(point), point.normal, to_eye) : LightLobe{};
}

/// BSDF of most opaque surfaces: a Lambertian lobe under a rough microfacet lobe. Free of branches, so that loops over
/// many points vectorise. On a GPU, and for other materials, Bsdf does the same.
class GlossyBsdf {
public:
    /// BSDF times cosine of each lobe, and the sampling densities of the lobes per steradian. Zero if the direction is
    /// below the surface.
    struct Value {
        Color diffuse, specular;
        float diffuse_pdf, specular_pdf;
    };

    /// `normal`: shading normal, on the eye's side.
    REALCAM_INLINE GlossyBsdf(const GlossySurface& surface, Vec3f normal, Vec3f geometric_normal, Vec3f to_eye)
        : frame_(visible_normal(normal, to_eye)),
          geometric_normal_(geometric_normal),
          eye_(frame_.to_local(to_eye)),
          alpha_(surface.alpha),
          to_eye_(inlined_ggx_albedo(eye_.z, alpha_)) {
        const GgxAlbedo mean = inlined_ggx_mean_albedo(alpha_);
        lost_ = 1.0f - mean.all;
        above_diffuse_ = FacetReflectance::between(surface.f0, surface.f90, lost_);
        reflectance_ = mix(above_diffuse_, FacetReflectance::between(surface.base, 1.0f, lost_), surface.metallic);
        const Color left_to_eye = grey(1.0f) - above_diffuse_.albedo(to_eye_);
        const Color left = grey(1.0f) - above_diffuse_.albedo(mean), diffuse = (1.0f - surface.metallic) * surface.base;
        const auto held = [](float v) { return select(v > 1e-4f, v, 1e-4f); };
        diffuse_ = diffuse * left_to_eye / Color{held(left.r), held(left.g), held(left.b)};
        diffuse_albedo_ = largest(diffuse * left_to_eye);
        specular_albedo_ = largest(reflectance_.albedo(to_eye_));
    }

    /// Albedos for the eye's direction, by which a lobe is chosen.
    REALCAM_INLINE float diffuse_albedo() const { return diffuse_albedo_; }
    REALCAM_INLINE float specular_albedo() const { return specular_albedo_; }

    REALCAM_INLINE Value eval(Vec3f to_light) const {
        const Vec3f light = frame_.to_local(to_light);
        const bool is_possible = (light.z > 0.0f) & (dot(geometric_normal_, to_light) > 0.0f);
        // Directions below the surface must not index outside the tables.
        const float cosine = select(is_possible, light.z, 1.0f), pdf = 0.3183098862f * cosine;
        const GgxAlbedo to_light_facets = inlined_ggx_albedo(cosine, alpha_);
        const Color diffuse = pdf * diffuse_ * (grey(1.0f) - above_diffuse_.albedo(to_light_facets));
        const Vec3f h = normalized(eye_ + light);
        const float density = ggx_density(h, alpha_) / (4.0f * eye_.z), lambda = ggx_lambda(eye_, alpha_);
        const float visible = 1.0f / (1.0f + lambda), both = 1.0f / (1.0f + lambda + ggx_lambda(light, alpha_));
        const float lost_twice = (1.0f - to_eye_.all) * (1.0f - to_light_facets.all);
        const float several = select(lost_ > 1e-6f, lost_twice * pdf / lost_, 0.0f);
        const Color specular = (density * both) * schlick(reflectance_.f0, reflectance_.f90, dot(eye_, h)) +
                               several * reflectance_.multiple;
        const float specular_pdf = to_eye_.all * visible * density + (1.0f - to_eye_.all) * (2.0f * kSpherePdf);
        const Color none = {0, 0, 0};
        return {select(is_possible, diffuse, none), select(is_possible, specular, none), select(is_possible, pdf, 0.0f),
                select(is_possible, specular_pdf, 0.0f)};
    }

    /// Samples a direction of one lobe; it may lie below the surface.
    REALCAM_INLINE Vec3f sample(bool is_diffuse, Vec2f u) const {
        const Vec3f h = sample_ggx(eye_, alpha_, {u.x / to_eye_.all, u.y});
        const Vec3f mirrored = (2.0f * dot(eye_, h)) * h - eye_;
        const float fresh = (u.x - to_eye_.all) / (1.0f - to_eye_.all);
        const Vec3f even = sample_sphere({select(fresh < 1.0f, 0.5f * fresh, 0.5f), u.y});
        const Vec3f specular = select(u.x < to_eye_.all, mirrored, even);
        return frame_.to_world(select(is_diffuse, sample_cosine({0, 0, 1}, u), specular));
    }

private:
    /// Branch-free version of make_bsdf_detail::visible_normal.
    REALCAM_INLINE static Vec3f visible_normal(Vec3f normal, Vec3f to_eye) {
        constexpr float kLeastCosine = 1e-3f;
        const float cosine = dot(normal, to_eye);
        return select(cosine >= kLeastCosine, normal, normalized(normal + (kLeastCosine - cosine) * to_eye));
    }

    ShadingFrame frame_;
    Vec3f geometric_normal_;
    Vec3f eye_;  ///< unit, in the local frame
    float alpha_, lost_;
    GgxAlbedo to_eye_;
    FacetReflectance above_diffuse_, reflectance_;
    Color diffuse_;  ///< reflectance times all factors that depend only on the direction of view
    float diffuse_albedo_, specular_albedo_;
};

}  // namespace REALCAM_NAMESPACE
