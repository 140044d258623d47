#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// A rotationally symmetric lens as polynomials of a film point and of a point in the plane of the last vertex.
///
/// By rotational symmetry, each vector that depends on the film point x and the point p in the last plane is a x + b p,
/// where a and b are polynomials in the dot products x.x, p.p and x.p (J. Hanika and C. Dachsbacher, "Efficient Monte
/// Carlo Rendering with Realistic Lenses", Computer Graphics Forum 33, 2014, with sparser variables).
struct LensPolynomialView {
    static constexpr int kVectors = 3;  ///< number of vectors: those of LensPolynomialRay

    /// Coefficients of a and b of each vector, for each monomial (x.x)^i (p.p)^j (x.p)^k with i + j + k <= degree:
    /// array of shape (terms, kVectors, 2). Of the monomials i changes slowest and k fastest.
    const float* coefficients;
    int terms;  ///< number of monomials
    int degree;  ///< largest degree of a monomial
    float inverse_film_radius, inverse_last_radius;  ///< factors that scale x and p to at most 1, 1/mm
    float plane;  ///< z of the plane in which positions are stated, mm from the front vertex
    float last_radius_squared, last_rim;  ///< last surface: squared radius of the rim, mm^2, and sag there, mm
    float front_radius_squared, front_rim;  ///< the same for the first surface
};

/// Ray in front of the lens, towards the scene, and its point in the stop.
struct LensPolynomialRay {
    Vec2f position;  ///< in the plane z = LensPolynomialView::plane, mm
    Vec2f direction;  ///< x and y of the unit vector
    Vec2f at_stop;  ///< in units of the radius of the stop
};

/// Returns the ray through the points `film` of the film and `last` of the plane of the last vertex, mm. Rims are not
/// tested.
REALCAM_INLINE LensPolynomialRay evaluate(const LensPolynomialView& lens, Vec2f film, Vec2f last) {
    const Vec2f x = {lens.inverse_film_radius * film.x, lens.inverse_film_radius * film.y};
    const Vec2f p = {lens.inverse_last_radius * last.x, lens.inverse_last_radius * last.y};
    const float u = x.x * x.x + x.y * x.y, v = p.x * p.x + p.y * p.y, w = x.x * p.x + x.y * p.y;
    constexpr int kSums = 2 * LensPolynomialView::kVectors;
    float sums[kSums] = {};
    const float* next = lens.coefficients;
    float power_u = 1.0f;
    for (int i = 0; i <= lens.degree; ++i, power_u *= u) {
        float power_uv = power_u;
        for (int j = 0; i + j <= lens.degree; ++j, power_uv *= v) {
            float monomial = power_uv;
            for (int k = 0; i + j + k <= lens.degree; ++k, monomial *= w, next += kSums)
                for (int s = 0; s < kSums; ++s) sums[s] += monomial * next[s];
        }
    }
    const auto vector = [&](int i) {
        const float a = sums[2 * i], b = sums[2 * i + 1];
        return Vec2f{a * x.x + b * p.x, a * x.y + b * p.y};
    };
    return {vector(0), vector(1), vector(2)};
}

}  // namespace REALCAM_NAMESPACE
