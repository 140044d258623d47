#pragma once
#include "../../math/random.hpp"
#include "dielectric_interface.hpp"
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"
#include "microfacet_reflection.hpp"
#include "plain_bsdf.hpp"

namespace REALCAM_NAMESPACE {

// Energy that a perfectly reflecting rough metal loses under a coat if the lower of the coat's two transmittances,
// towards the eye and towards the light, is applied (Bsdf::eval); from a table (tools/make_loss_tables.py) for a coat
// of weight 1. The loss is proportional to the weight.

namespace coat_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kCoatLayers = REALCAM_COAT_LAYERS, kCoatRows = REALCAM_COAT_ROWS,
                     kCoatColumns = REALCAM_COAT_COLUMNS;

}  // namespace coat_loss_detail

/// Loss, 0 to 1, at the cosine of the angle between normal and direction of view. `coat_alpha`, `metal_alpha`: GGX
/// alpha of the two layers.
REALCAM_HD inline float coat_loss(float cosine, float coat_alpha, float metal_alpha) {
    using namespace coat_loss_detail;
    static constexpr float kLoss[] = {REALCAM_COAT_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * kCoatLayers * kCoatRows * kCoatColumns);
    const TablePosition layer = table_position(std::sqrt(coat_alpha), kCoatLayers),
                        row = table_position(std::sqrt(metal_alpha), kCoatRows),
                        column = table_position(std::sqrt(cosine), kCoatColumns);
    const float* upper = kLoss + layer.index * kCoatRows * kCoatColumns;
    return between(read_table(upper, row, column, kCoatColumns),
                   read_table(upper + kCoatRows * kCoatColumns, row, column, kCoatColumns), layer.fraction);
}

/// Cosine-weighted mean of coat_loss over the hemisphere.
REALCAM_HD inline float coat_mean_loss(float coat_alpha, float metal_alpha) {
    using namespace coat_loss_detail;
    static constexpr float kLoss[] = {REALCAM_COAT_MEAN_LOSS};
    static_assert(sizeof kLoss == sizeof(float) * kCoatLayers * kCoatRows);
    return read_table(kLoss, table_position(std::sqrt(coat_alpha), kCoatLayers),
                      table_position(std::sqrt(metal_alpha), kCoatRows), kCoatRows);
}

/// BSDF of a surface point for one direction of view: the sum of up to six lobes, which make_bsdf.hpp sets according to
/// the material model. Directions are unit vectors in the scene's axes, pointing away from the surface; local ones have
/// the shading normal as z axis.
class Bsdf {
public:
    ShadingFrame frame;
    Vec3f geometric_normal;  ///< on the eye's side, like frame.z
    Vec3f eye;  ///< direction to the eye (pbrt's wo), local

    Color diffuse = {0, 0, 0};  ///< reflectance
    /// Reflectance of the specular layer over the diffuse lobe, with facets as rough as those of `specular`; the
    /// diffuse lobe gets the transmitted share.
    FacetReflectance above_diffuse;
    Color phong = {0, 0, 0};  ///< reflectance of the Phong lobe
    float shininess = 0;  ///< Phong exponent
    Color mirror = {0, 0, 0};  ///< reflectance for this direction of view
    MicrofacetReflection specular;
    float specular_weight = 1;  ///< multiplies the whole `specular` lobe
    DielectricInterface interface;
    float coat_weight = 0;  ///< coverage of `coat`, 0 to 1
    MicrofacetReflection coat;
    HalfRotation coat_rotation;  ///< rotates local directions into the frame of the coat's own normal, and back

    REALCAM_INLINE Bsdf(Vec3f normal, Vec3f geometric_normal_, Vec3f to_eye)
        : frame(normal), geometric_normal(geometric_normal_), eye(frame.to_local(to_eye)) {}

    /// Computes the factors of the lobes for this direction of view and their sampling probabilities. Must be called
    /// after all lobes have been set.
    REALCAM_HD void prepare() {
        is_layered_ = above_diffuse.f90 > 0.0f || coat_weight > 0.0f;
        through_coat_ = through_coat(coat.to_eye);
        transmitted_to_eye_ = grey(1.0f) - above_diffuse.albedo(specular.to_eye);
        diffuse_ = diffuse;
        if (is_layered_) diffuse_ = through_coat_ * diffuse * transmitted_to_eye_ / mean_transmitted();
        // The loss tables assume that the coat has the normal of the base.
        if (coat_weight > 0.0f && !specular.is_smooth() && coat_rotation.is_identity()) prepare_lost_under_coat();
        set_lobe_probabilities();
    }

    REALCAM_INLINE bool is_opaque() const { return !(interface.weight > 0.0f); }
    /// Removes the Lambertian lobe.
    REALCAM_INLINE void remove_diffuse_lobe() {
        diffuse = diffuse_ = lost_under_coat_ = {0, 0, 0};
        set_lobe_probabilities();
    }
    /// Removes all lobes except mirrors and smooth interfaces.
    REALCAM_INLINE void keep_delta_lobes() {
        diffuse = diffuse_ = phong = lost_under_coat_ = {0, 0, 0};
        if (!specular.is_smooth()) specular_weight = 0.0f;
        if (!coat.is_smooth()) coat_weight = 0.0f;
        if (!interface.is_smooth()) interface.weight = 0.0f;
        set_lobe_probabilities();
    }

    /// BSDF times cosine; mirrors and smooth interfaces (delta lobes) contribute 0.
    REALCAM_HD Color eval(Vec3f to_light) const {
        const Vec3f light = frame.to_local(to_light);
        if (!is_possible(light, to_light)) return {0, 0, 0};
        if (light.z < 0.0f) return through_coat_ * interface.eval(eye, light);
        const Vec3f coat_light = coat_weight > 0.0f ? coat_rotation(light) : light;
        const float light_through_coat =
            coat_weight > 0.0f && coat_light.z > 0.0f ? through_coat(coat.facets_at(coat_light.z)) : 1.0f;
        Color value = (kInvPi * light.z) * diffuse_;
        if (is_layered_) value *= light_through_coat * transmitted_at(light.z);
        // Light of the narrow lobes passes the coat twice at about the same angle, and interreflections between coat
        // and base are not lost: so the transmittance of a single passage applies. If the two angles differ, the lower
        // transmittance is taken, so that no energy is gained; the energy lost by this returns in a lobe of its own, as
        // multiple scattering does in MicrofacetReflection.
        const float coated = through_coat_ < light_through_coat ? through_coat_ : light_through_coat;
        if (!is_black(phong)) value += (coated * phong_value(eye, shininess, light)) * phong;
        if (lobe_probabilities_[kSpecularLobe] > 0.0f) value += (coated * specular_weight) * specular.eval(eye, light);
        if (!is_black(lost_under_coat_)) value += light.z * lost_under_coat(light.z) * lost_under_coat_;
        // The coat attenuates on the eye's side only, like light from below.
        if (interface.weight > 0.0f) value += through_coat_ * interface.eval(eye, light);
        if (coat_weight > 0.0f && coat_light.z > 0.0f) value += coat_weight * coat.eval(coat_rotation(eye), coat_light);
        return value;
    }

    /// Density of sample(), per steradian; mirrors and smooth interfaces (delta lobes) contribute 0.
    REALCAM_HD float pdf(Vec3f to_light) const {
        const Vec3f light = frame.to_local(to_light);
        if (!is_possible(light, to_light)) return 0.0f;
        if (light.z < 0.0f) return lobe_probabilities_[kInterfaceLobe] * interface.pdf(eye, light);
        float density = lobe_probabilities_[kDiffuseLobe] * kInvPi * light.z;
        if (lobe_probabilities_[kPhongLobe] > 0.0f)
            density += lobe_probabilities_[kPhongLobe] * phong_pdf({-eye.x, -eye.y, eye.z}, shininess, light);
        if (lobe_probabilities_[kSpecularLobe] > 0.0f)
            density += lobe_probabilities_[kSpecularLobe] * specular.pdf(eye, light);
        if (lobe_probabilities_[kInterfaceLobe] > 0.0f)
            density += lobe_probabilities_[kInterfaceLobe] * interface.pdf(eye, light);
        if (lobe_probabilities_[kCoatLobe] > 0.0f && coat_rotation(light).z > 0.0f)
            density += lobe_probabilities_[kCoatLobe] * coat.pdf(coat_rotation(eye), coat_rotation(light));
        return density;
    }

    /// Samples a direction: chooses a lobe by its reflectance, then a direction in it. `choice` is a third random
    /// number, which only rough interfaces need. Returns a weight of black if the BSDF is black or the sampled
    /// direction is impossible.
    REALCAM_HD BsdfSample sample(Vec2f u, float choice) const {
        BsdfSample result{geometric_normal, {0, 0, 0}, 0.0f, false};
        if (!(total_ > 0.0f)) return result;
        int lobe = kDiffuseLobe;
        while (lobe < kCoatLobe && u.x >= lobe_probabilities_[lobe]) u.x -= lobe_probabilities_[lobe++];
        const float probability = lobe_probabilities_[lobe];
        if (!(probability > 0.0f)) return result;
        u.x = remapped_random(u.x, probability);
        Vec3f light{0, 0, 1};
        switch (lobe) {
            case kDiffuseLobe: light = sample_cosine({0, 0, 1}, u); break;
            case kPhongLobe: light = sample_phong({-eye.x, -eye.y, eye.z}, shininess, u); break;
            case kSpecularLobe:
                light = specular.sample(eye, u);
                if (specular.is_smooth()) {
                    const float factor = through_coat_ * specular_weight / probability;
                    return delta(light, factor * specular.albedo_to_eye());
                }
                break;
            case kInterfaceLobe: {
                const BsdfSample sampled = interface.sample(eye, u, interface.is_smooth() ? u.x : choice);
                if (is_black(sampled.weight)) return result;
                light = sampled.direction;
                if (interface.is_smooth())
                    result = delta(light, (through_coat_ * interface.weight / probability) * sampled.weight);
                result.refracted = sampled.refracted;
                if (interface.is_smooth()) return result;
                break;
            }
            case kMirrorLobe: return delta({-eye.x, -eye.y, eye.z}, (1.0f / probability) * mirror);
            default:
                light = coat_rotation(coat.sample(coat_rotation(eye), u));
                if (coat.is_smooth()) return delta(light, (coat_weight / probability) * coat.albedo_to_eye());
        }
        // Facets may reflect light below the surface, where it would hit other facets; multiple scattering is a lobe of
        // its own.
        if (lobe != kInterfaceLobe && !(light.z > 0.0f)) return result;
        result.direction = frame.to_world(light);
        result.pdf = pdf(result.direction);
        if (result.pdf > 0.0f) result.weight = (1.0f / result.pdf) * eval(result.direction);
        return result;
    }

private:
    /// Lobes, in the order in which sample() chooses among them.
    enum Lobe : int { kDiffuseLobe, kPhongLobe, kSpecularLobe, kInterfaceLobe, kMirrorLobe, kCoatLobe, kLobeCount };

    // Six-point Gaussian quadrature in the squared cosine, which makes the mean over the hemisphere cosine-weighted.
    static constexpr int kGaussPoints = 6;
    struct GaussPoint {
        float cosine, weight;
    };
    REALCAM_INLINE static GaussPoint gauss_point(int i) {
        constexpr float kSquares[kGaussPoints] = {0.03376524f, 0.16939531f, 0.38069041f,
                                                  0.61930959f, 0.83060469f, 0.96623476f};
        constexpr float kWeights[kGaussPoints] = {0.08566225f, 0.18038079f, 0.23395697f,
                                                  0.23395697f, 0.18038079f, 0.08566225f};
        return {std::sqrt(kSquares[i]), kWeights[i]};
    }

    /// Loss of this surface under its coat at a cosine: the loss of a perfect reflector times the specular albedo.
    REALCAM_INLINE Color lost_under_coat(float cosine) const {
        return coat_loss(cosine, coat.alpha, specular.alpha) * specular.reflectance.albedo(specular.facets_at(cosine));
    }
    /// Sets the lobe that returns the energy lost under the coat.
    REALCAM_HD void prepare_lost_under_coat() {
        const float mean = coat_mean_loss(coat.alpha, specular.alpha);
        if (!(mean > 1e-6f)) return;
        // The tabulated mean loss times the loss-weighted mean reflectance: in that ratio most of the quadrature error
        // cancels.
        Color coloured{0, 0, 0};
        float white = 0.0f;
        for (int i = 0; i < kGaussPoints; ++i) {
            const GaussPoint p = gauss_point(i);
            coloured += p.weight * lost_under_coat(p.cosine);
            white += p.weight * coat_loss(p.cosine, coat.alpha, specular.alpha);
        }
        const Color to_eye = (coat_weight * specular_weight) * lost_under_coat(eye.z);
        lost_under_coat_ = kInvPi * to_eye / at_least((mean / white) * coloured, 1e-8f);
        lost_to_eye_ = largest(to_eye);
    }
    /// Transmittance of the coat for a single passage, from its directional albedo for reflectance 1.
    REALCAM_INLINE float through_coat(GgxAlbedo facets) const {
        return coat_weight > 0.0f ? 1.0f - coat_weight * coat.reflectance.albedo(facets).r : 1.0f;
    }
    /// Fraction of light at a cosine that the specular lobe transmits to the diffuse one.
    REALCAM_INLINE Color transmitted_at(float cosine) const {
        return grey(1.0f) - above_diffuse.albedo(specular.facets_at(cosine));
    }
    /// Cosine-weighted mean of the fraction that coat and specular lobe transmit. Dividing the diffuse lobe by it makes
    /// these two the only losses of diffuse light.
    REALCAM_HD Color mean_transmitted() const {
        if (!(coat_weight > 0.0f)) return at_least(grey(1.0f) - above_diffuse.albedo(specular.mean));
        Color sum{0, 0, 0};
        for (int i = 0; i < kGaussPoints; ++i) {
            const GaussPoint p = gauss_point(i);
            sum += (p.weight * through_coat(coat.facets_at(p.cosine))) * transmitted_at(p.cosine);
        }
        return at_least(sum);
    }
    /// Clamps a divisor away from 0.
    REALCAM_INLINE static Color at_least(Color c, float least = 1e-4f) {
        const auto clamped = [=](float v) { return v > least ? v : least; };
        return {clamped(c.r), clamped(c.g), clamped(c.b)};
    }

    /// True if the direction is on the same side of the shading and the geometric normal; below the surface only if the
    /// interface transmits.
    REALCAM_INLINE bool is_possible(Vec3f light, Vec3f to_light) const {
        const bool above = dot(geometric_normal, to_light) > 0.0f;
        return above ? light.z > 0.0f : light.z < 0.0f && interface.weight > 0.0f;
    }

    /// Sample of a delta lobe in a local direction.
    REALCAM_INLINE BsdfSample delta(Vec3f light, Color weight) const {
        const Vec3f direction = frame.to_world(light);
        return {direction, select(is_possible(light, direction), weight, Color{0, 0, 0}), kDelta, false};
    }

    /// Sets the sampling probabilities of the lobes.
    REALCAM_INLINE void set_lobe_probabilities() {
        lobe_probabilities_[kDiffuseLobe] = through_coat_ * largest(diffuse * transmitted_to_eye_);
        if (!is_black(lost_under_coat_)) lobe_probabilities_[kDiffuseLobe] += lost_to_eye_;
        lobe_probabilities_[kPhongLobe] = through_coat_ * largest(phong);
        lobe_probabilities_[kSpecularLobe] = through_coat_ * specular_weight * largest(specular.albedo_to_eye());
        lobe_probabilities_[kInterfaceLobe] = through_coat_ * interface.weight;
        lobe_probabilities_[kMirrorLobe] = largest(mirror);
        lobe_probabilities_[kCoatLobe] = coat_weight > 0.0f ? coat_weight * coat.albedo_to_eye().r : 0.0f;
        total_ = lobe_probabilities_[kDiffuseLobe] + lobe_probabilities_[kPhongLobe] +
                 lobe_probabilities_[kSpecularLobe] + lobe_probabilities_[kInterfaceLobe] +
                 lobe_probabilities_[kMirrorLobe] + lobe_probabilities_[kCoatLobe];
        if (!(total_ > 0.0f)) return;
        REALCAM_UNROLL
        for (int i = 0; i < kLobeCount; ++i) lobe_probabilities_[i] /= total_;
    }

    bool is_layered_;  ///< the diffuse lobe lies below a specular lobe or a coat
    /// Fraction of light that the specular lobe transmits to the diffuse one, for the eye's direction.
    Color transmitted_to_eye_;
    Color diffuse_;  ///< reflectance times all factors that depend only on the direction of view
    Color lost_under_coat_ = {0, 0, 0};  ///< loss under the coat towards the eye, over pi times the mean loss
    float lost_to_eye_ = 0;  ///< largest channel of the loss under the coat towards the eye
    float through_coat_;  ///< transmittance of the coat for the eye's direction
    /// Sampling probability of each lobe; the energy lost under the coat belongs to the diffuse lobe.
    float lobe_probabilities_[kLobeCount];
    float total_;  ///< sum of the lobes' albedos; 0: the BSDF is black
};

}  // namespace REALCAM_NAMESPACE
