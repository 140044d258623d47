#pragma once
#include "../../math/random.hpp"
#include "dielectric_border.hpp"
#include "ggx_albedo.hpp"
#include "loss_tables.hpp"
#include "microfacet_reflection.hpp"
#include "plain_bsdf.hpp"

namespace REALCAM_NAMESPACE {

// Energy that a perfectly reflecting rough metal loses under a coat if the lower of the coat's two transmittances,
// towards the eye and towards the light, is applied (bsdf.hpp); from a table (tools/make_loss_tables.py) for a coat of
// weight 1. The loss is proportional to the weight.

namespace coat_loss_detail {

using ggx_albedo_detail::between;
using ggx_albedo_detail::read_table;
using ggx_albedo_detail::table_position;
using ggx_albedo_detail::TablePosition;

inline constexpr int kCoatLayers = REALCAM_COAT_LAYERS, kCoatRows = REALCAM_COAT_ROWS,
                     kCoatColumns = REALCAM_COAT_COLUMNS;

}  // namespace coat_loss_detail

/// Loss at the cosine of the angle between normal and direction of view.
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
/// the material model. Directions are unit vectors in the scene's axes, pointing away from the surface.
class Bsdf {
public:
    ShadingFrame frame;
    Vec3f geometric_normal;  ///< on the eye's side, like frame.z
    Vec3f eye;  ///< unit, in the local frame

    Color diffuse = {0, 0, 0};  ///< reflectance
    /// Reflectance of the specular layer over the diffuse lobe, with facets as rough as those of `specular`; the
    /// diffuse lobe gets the transmitted share.
    FacetReflectance above_diffuse;
    Color phong = {0, 0, 0};  ///< reflectance of the Phong lobe
    float shininess = 0;
    Color mirror = {0, 0, 0};  ///< reflectance for this direction of view
    MicrofacetReflection specular;
    float specular_weight = 1;  ///< multiplies the whole `specular` lobe
    DielectricBorder border;
    float coat_weight = 0;  ///< coverage of `coat`, 0 to 1
    MicrofacetReflection coat;
    HalfTurn coat_turn;  ///< rotates directions into the frame of the coat's own normal

    REALCAM_INLINE Bsdf(Vec3f normal, Vec3f geometric_normal_, Vec3f to_eye)
        : frame(normal), geometric_normal(geometric_normal_), eye(frame.to_local(to_eye)) {}

    /// Must be called after all lobes have been set.
    REALCAM_HD void prepare() {
        is_layered_ = above_diffuse.f90 > 0.0f || coat_weight > 0.0f;
        through_coat_ = through_coat(coat.to_eye);
        left_to_eye_ = grey(1.0f) - above_diffuse.albedo(specular.to_eye);
        diffuse_ = diffuse;
        if (is_layered_) diffuse_ = through_coat_ * diffuse * left_to_eye_ / mean_left();
        // The loss tables assume that the coat has the normal of the base.
        if (coat_weight > 0.0f && !specular.is_smooth() && coat_turn.is_none()) prepare_lost_under_coat();
        choose_lobes();
    }

    REALCAM_INLINE bool is_opaque() const { return !(border.weight > 0.0f); }
    /// Removes the Lambertian lobe.
    REALCAM_INLINE void keep_narrow_lobes() {
        diffuse = diffuse_ = lost_under_coat_ = {0, 0, 0};
        choose_lobes();
    }
    /// Removes all lobes except mirrors and smooth borders.
    REALCAM_INLINE void keep_mirrors() {
        diffuse = diffuse_ = phong = lost_under_coat_ = {0, 0, 0};
        if (!specular.is_smooth()) specular_weight = 0.0f;
        if (!coat.is_smooth()) coat_weight = 0.0f;
        if (!border.is_smooth()) border.weight = 0.0f;
        choose_lobes();
    }

    /// BSDF times cosine; mirrors and smooth borders (delta lobes) contribute 0.
    REALCAM_HD Color eval(Vec3f to_light) const {
        const Vec3f light = frame.to_local(to_light);
        if (!is_possible(light, to_light)) return {0, 0, 0};
        if (light.z < 0.0f) return through_coat_ * border.eval(eye, light);
        const Vec3f coat_light = coat_weight > 0.0f ? coat_turn(light) : light;
        const float in = coat_weight > 0.0f && coat_light.z > 0.0f ? through_coat(coat.facets_at(coat_light.z)) : 1.0f;
        Color value = (0.3183098862f * light.z) * diffuse_;
        if (is_layered_) value *= in * left_at(light.z);
        // Light of the narrow lobes passes the coat twice at about the same angle, and interreflections between coat
        // and base are not lost: so the transmittance of a single passage applies. If the two angles differ, the lower
        // transmittance is taken, so that no energy is gained; the energy lost by this returns in a lobe of its own, as
        // multiple scattering does in MicrofacetReflection.
        const float coated = through_coat_ < in ? through_coat_ : in;
        if (!is_black(phong)) value += (coated * phong_value(eye, shininess, light)) * phong;
        if (share_[2] > 0.0f) value += (coated * specular_weight) * specular.eval(eye, light);
        if (!is_black(lost_under_coat_)) value += light.z * lost_under_coat(light.z) * lost_under_coat_;
        // The coat attenuates on the eye's side only, like light from below.
        if (border.weight > 0.0f) value += through_coat_ * border.eval(eye, light);
        if (coat_weight > 0.0f && coat_light.z > 0.0f) value += coat_weight * coat.eval(coat_turn(eye), coat_light);
        return value;
    }

    /// Density of sample(), per steradian; mirrors and smooth borders (delta lobes) contribute 0.
    REALCAM_HD float pdf(Vec3f to_light) const {
        const Vec3f light = frame.to_local(to_light);
        if (!is_possible(light, to_light)) return 0.0f;
        if (light.z < 0.0f) return share_[3] * border.pdf(eye, light);
        float density = share_[0] * 0.3183098862f * light.z;
        if (share_[1] > 0.0f) density += share_[1] * phong_pdf({-eye.x, -eye.y, eye.z}, shininess, light);
        if (share_[2] > 0.0f) density += share_[2] * specular.pdf(eye, light);
        if (share_[3] > 0.0f) density += share_[3] * border.pdf(eye, light);
        if (share_[5] > 0.0f && coat_turn(light).z > 0.0f)
            density += share_[5] * coat.pdf(coat_turn(eye), coat_turn(light));
        return density;
    }

    /// Chooses a lobe by its reflectance, then a direction. `choice` is a third random number, which only rough borders
    /// need.
    REALCAM_HD BsdfSample sample(Vec2f u, float choice) const {
        BsdfSample result{geometric_normal, {0, 0, 0}, 0.0f, false};
        if (!(total_ > 0.0f)) return result;
        int lobe = 0;
        while (lobe < 5 && u.x >= share_[lobe]) u.x -= share_[lobe++];
        const float share = share_[lobe];
        if (!(share > 0.0f)) return result;
        u.x = left_over(u.x, share);
        Vec3f light{0, 0, 1};
        switch (lobe) {
            case 0: light = sample_cosine({0, 0, 1}, u); break;
            case 1: light = sample_phong({-eye.x, -eye.y, eye.z}, shininess, u); break;
            case 2:
                light = specular.sample(eye, u);
                if (specular.is_smooth()) {
                    const float factor = through_coat_ * specular_weight / share;
                    return delta(light, factor * specular.albedo_to_eye());
                }
                break;
            case 3: {
                const BsdfSample passed = border.sample(eye, u, border.is_smooth() ? u.x : choice);
                if (is_black(passed.weight)) return result;
                light = passed.direction;
                if (border.is_smooth()) result = delta(light, (through_coat_ * border.weight / share) * passed.weight);
                result.refracted = passed.refracted;
                if (border.is_smooth()) return result;
                break;
            }
            case 4: return delta({-eye.x, -eye.y, eye.z}, (1.0f / share) * mirror);
            default:
                light = coat_turn(coat.sample(coat_turn(eye), u));
                if (coat.is_smooth()) return delta(light, (coat_weight / share) * coat.albedo_to_eye());
        }
        // Facets may reflect light below the surface, where it would hit other facets; multiple scattering is a lobe of
        // its own.
        if (lobe != 3 && !(light.z > 0.0f)) return result;
        result.direction = frame.to_world(light);
        result.pdf = pdf(result.direction);
        if (result.pdf > 0.0f) result.weight = (1.0f / result.pdf) * eval(result.direction);
        return result;
    }

private:
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
        lost_under_coat_ = 0.3183098862f * to_eye / at_least((mean / white) * coloured, 1e-8f);
        lost_share_ = largest(to_eye);
    }
    REALCAM_INLINE float through_coat(GgxAlbedo facets) const {
        return coat_weight > 0.0f ? 1.0f - coat_weight * coat.reflectance.albedo(facets).r : 1.0f;
    }
    /// Share of light at a cosine that the specular lobe transmits to the diffuse one.
    REALCAM_INLINE Color left_at(float cosine) const {
        return grey(1.0f) - above_diffuse.albedo(specular.facets_at(cosine));
    }
    /// Cosine-weighted mean of the share that coat and specular lobe transmit. Dividing the diffuse lobe by it makes
    /// these two the only losses of diffuse light.
    REALCAM_HD Color mean_left() const {
        if (!(coat_weight > 0.0f)) return at_least(grey(1.0f) - above_diffuse.albedo(specular.mean));
        Color sum{0, 0, 0};
        for (int i = 0; i < kGaussPoints; ++i) {
            const GaussPoint p = gauss_point(i);
            sum += (p.weight * through_coat(coat.facets_at(p.cosine))) * left_at(p.cosine);
        }
        return at_least(sum);
    }
    /// Clamps a divisor away from 0.
    REALCAM_INLINE static Color at_least(Color c, float least = 1e-4f) {
        const auto held = [=](float v) { return v > least ? v : least; };
        return {held(c.r), held(c.g), held(c.b)};
    }

    /// True if the direction is on the same side of the shading and the geometric normal; below the surface only if the
    /// border transmits.
    REALCAM_INLINE bool is_possible(Vec3f light, Vec3f to_light) const {
        const bool above = dot(geometric_normal, to_light) > 0.0f;
        return above ? light.z > 0.0f : light.z < 0.0f && border.weight > 0.0f;
    }

    REALCAM_INLINE BsdfSample delta(Vec3f light, Color weight) const {
        const Vec3f direction = frame.to_world(light);
        return {direction, select(is_possible(light, direction), weight, Color{0, 0, 0}), kDelta, false};
    }

    REALCAM_INLINE void choose_lobes() {
        share_[0] = through_coat_ * largest(diffuse * left_to_eye_);
        if (!is_black(lost_under_coat_)) share_[0] += lost_share_;
        share_[1] = through_coat_ * largest(phong);
        share_[2] = through_coat_ * specular_weight * largest(specular.albedo_to_eye());
        share_[3] = through_coat_ * border.weight;
        share_[4] = largest(mirror);
        share_[5] = coat_weight > 0.0f ? coat_weight * coat.albedo_to_eye().r : 0.0f;
        total_ = share_[0] + share_[1] + share_[2] + share_[3] + share_[4] + share_[5];
        if (!(total_ > 0.0f)) return;
        REALCAM_UNROLL
        for (int i = 0; i < 6; ++i) share_[i] /= total_;
    }

    bool is_layered_;
    /// Share of light that the specular lobe transmits to the diffuse one, for the eye's direction.
    Color left_to_eye_;
    Color diffuse_;  ///< reflectance times all factors that depend only on the direction of view
    Color lost_under_coat_ = {0, 0, 0};  ///< loss under the coat towards the eye, over pi times the mean loss
    float lost_share_ = 0;
    float through_coat_;
    /// Sampling probabilities of the lobes: diffuse with the loss under the coat, Phong, specular, border, mirror,
    /// coat.
    float share_[6];
    float total_;
};

}  // namespace REALCAM_NAMESPACE
