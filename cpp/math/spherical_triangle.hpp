#pragma once
#include "lanes.hpp"
#include "sincos.hpp"

namespace REALCAM_NAMESPACE {

namespace spherical_triangle_detail {

/// Arc tangent of numerator / denominator, a quotient from 0 to 1, with a relative error of 2e-7. Like cos_sin_of_turn
/// it uses only basic arithmetic.
REALCAM_INLINE float arc_tangent(float numerator, float denominator) {
    constexpr float kTanPi8 = 0.4142135624f, kPi4 = 0.7853981634f;  // tan(pi / 8) and pi / 4
    // Above tan(pi / 8): atan(x) = pi / 4 + atan((x - 1) / (x + 1)). The first omitted term of the series is 1e-7
    // there.
    const bool is_large = numerator > kTanPi8 * denominator;
    const float y = select(is_large, numerator - denominator, numerator) /
                    select(is_large, numerator + denominator, at_least(denominator, 1e-30f));
    const float y2 = y * y;
    const float slope =
        1.0f + y2 * (-1.0f / 3 + y2 * (1.0f / 5 + y2 * (-1.0f / 7 + y2 * (1.0f / 9 + y2 * (-1.0f / 11 + y2 / 13)))));
    return select(is_large, kPi4, 0.0f) + y * slope;
}

}  // namespace spherical_triangle_detail

/// Triangle projected onto the unit sphere around a point, for sampling by solid angle. The code has no branches, so
/// that loops over lanes become vector code.
class SphericalTriangle {
public:
    /// `a`, `b`, `c`: vertices relative to the point; `double_area`: twice the area of the flat triangle; `height`:
    /// distance of the point from its plane.
    REALCAM_INLINE SphericalTriangle(Vec3f a, Vec3f b, Vec3f c, float double_area, float height) {
        using namespace spherical_triangle_detail;
        inverse_a_ = 1.0f / std::sqrt(at_least(dot(a, a), 1e-30f));
        inverse_b_ = 1.0f / std::sqrt(at_least(dot(b, b), 1e-30f));
        inverse_c_ = 1.0f / std::sqrt(at_least(dot(c, c), 1e-30f));
        a_ = inverse_a_ * a;
        b_ = inverse_b_ * b;
        c_ = inverse_c_ * c;
        ab_ = dot(a_, b_);
        ac_ = dot(a_, c_);
        bc_ = dot(b_, c_);
        // a . (b x c) of the unit vectors, without the cancellation if they are almost coplanar.
        volume_ = double_area * height * inverse_a_ * inverse_b_ * inverse_c_;
        // tan(solid angle / 2) = volume / base (van Oosterom and Strackee 1983); two half-angle formulas give the
        // tangent of an eighth of the solid angle.
        const float base = 1.0f + ab_ + ac_ + bc_, sum = base + std::sqrt(volume_ * volume_ + base * base);
        solid_angle = 8.0f * arc_tangent(volume_, sum + std::sqrt(volume_ * volume_ + sum * sum));
    }

    /// Samples a point of the triangle uniformly by solid angle, from u in [0, 1)^2 (Arvo 1995). Returns its
    /// barycentric coordinates: x is the weight of `b`, and y that of `c`.
    REALCAM_INLINE Vec2f sample(Vec2f u) const {
        // The point on the arc from a to c that cuts off a fraction u.x of the solid angle: twice as far from a as the
        // direction forward * a + sideward * along, where `along` is the component of c that is perpendicular to a.
        const Vec2f half = cos_sin_of_turn(u.x * solid_angle * (0.5f * kTurnPdf));
        const float across = bc_ - ab_ * ac_, forward = volume_ * half.x - across * half.y,
                    sideways = half.y * (1.0f + ab_);
        const float squared = forward * forward + sideways * sideways * (1.0f - ac_ * ac_);
        const float twice = 2.0f * forward / at_least(squared, 1e-36f);
        const float weight_c = at_least(twice * sideways, 0.0f),
                    weight_a = at_least(twice * forward - 1.0f - weight_c * ac_, 0.0f);
        // The point on the arc from b to that point, drawn uniformly in the cosine of the angle from b. weight_arc
        // scales the previous point.
        const Vec3f offset = weight_a * a_ + weight_c * c_ - b_;
        const float one_minus_cosine = 0.5f * dot(offset, offset), one_minus_drawn = u.y * one_minus_cosine;
        const float weight_arc = std::sqrt(u.y * (2.0f - one_minus_drawn) / at_least(2.0f - one_minus_cosine, 1e-7f));
        const float weight_b = (1.0f - one_minus_drawn) - weight_arc * (1.0f - one_minus_cosine);
        // The direction is a weighted sum of the unit vectors to the vertices. Divided by the vertices' distances, the
        // weights are proportional to the barycentric coordinates.
        const float flat_a = weight_arc * weight_a * inverse_a_, flat_b = at_least(weight_b, 0.0f) * inverse_b_,
                    flat_c = weight_arc * weight_c * inverse_c_;
        const float scale = 1.0f / (flat_a + flat_b + flat_c);
        return {scale * flat_b, scale * flat_c};
    }

    float solid_angle;  ///< steradians

private:
    Vec3f a_, b_, c_;  // unit vectors to the vertices
    float inverse_a_, inverse_b_, inverse_c_;  // inverse distances of the vertices
    float ab_, ac_, bc_;  // cosines of the angles between them
    float volume_;  // their triple product
};

}  // namespace REALCAM_NAMESPACE
