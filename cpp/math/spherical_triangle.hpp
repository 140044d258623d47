#pragma once
#include "lanes.hpp"
#include "sincos.hpp"

namespace REALCAM_NAMESPACE {

namespace spherical_triangle_detail {

/// Arc tangent of a quotient from 0 to 1, with a relative error of 2e-7. Plain arithmetic, as cos_sin_of_turn.
REALCAM_INLINE float arc_tangent(float numerator, float denominator) {
    // atan(x) = pi/4 + atan((x - 1) / (x + 1)). The first term of the series that is omitted is 1e-7 at tan(pi/8).
    const bool is_large = numerator > 0.4142135624f * denominator;
    const float y = select(is_large, numerator - denominator, numerator) /
                    select(is_large, numerator + denominator, at_least(denominator, 1e-30f));
    const float y2 = y * y;
    const float slope =
        1.0f + y2 * (-1.0f / 3 + y2 * (1.0f / 5 + y2 * (-1.0f / 7 + y2 * (1.0f / 9 + y2 * (-1.0f / 11 + y2 / 13)))));
    return select(is_large, 0.7853981634f, 0.0f) + y * slope;
}

}  // namespace spherical_triangle_detail

/// A triangle projected onto the unit sphere around a point. Without branches, so that it becomes vector code.
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

    /// Returns the barycentric coordinates, for `b` and `c`, of a point drawn uniformly by solid angle (Arvo 1995).
    REALCAM_INLINE Vec2f sample(Vec2f u) const {
        // The point on the arc from a to c that cuts off a fraction u.x of the solid angle: twice as far from a as the
        // direction forward * a + sideward * along, where `along` is the component of c that is perpendicular to a.
        const Vec2f half = cos_sin_of_turn(u.x * solid_angle * (0.5f * kTurnPdf));
        const float across = bc_ - ab_ * ac_, forward = volume_ * half.x - across * half.y,
                    sideward = half.y * (1.0f + ab_);
        const float squared = forward * forward + sideward * sideward * (1.0f - ac_ * ac_);
        const float twice = 2.0f * forward / at_least(squared, 1e-36f);
        const float of_c = at_least(twice * sideward, 0.0f), of_a = at_least(twice * forward - 1.0f - of_c * ac_, 0.0f);
        // The point on the arc from b to that point, drawn uniformly in the cosine of the angle from b.
        const Vec3f offset = of_a * a_ + of_c * c_ - b_;
        const float all = 0.5f * dot(offset, offset), part = u.y * all;
        const float of_arc = std::sqrt(u.y * (2.0f - part) / at_least(2.0f - all, 1e-7f));
        const float of_b = (1.0f - part) - of_arc * (1.0f - all);
        // Directions are sums of vertices with these weights, and so is the point.
        const float at_a = of_arc * of_a * inverse_a_, at_b = at_least(of_b, 0.0f) * inverse_b_,
                    at_c = of_arc * of_c * inverse_c_;
        const float scale = 1.0f / (at_a + at_b + at_c);
        return {scale * at_b, scale * at_c};
    }

    float solid_angle;

private:
    Vec3f a_, b_, c_;  // unit
    float inverse_a_, inverse_b_, inverse_c_;  // inverse distances of the vertices
    float ab_, ac_, bc_;  // cosines
    float volume_;
};

}  // namespace REALCAM_NAMESPACE
