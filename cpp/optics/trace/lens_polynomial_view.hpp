#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// A lens as polynomials in a film point and a point in the plane of the last vertex.
///
/// By rotational symmetry, each vector that the lens makes of the film point x and the last point p is a x + b p, with
/// a and b polynomials in x^2, p^2 and x p (J. Hanika and C. Dachsbacher, "Efficient Monte Carlo Rendering with
/// Realistic Lenses", Computer Graphics Forum 33, 2014, with sparser variables).
struct LensPolynomialView {
    static constexpr int kVectors = 3;

    /// The coefficients (a, b) of each monomial for each vector. The power of x^2 changes slowest and that of x p
    /// fastest.
    const float* coefficients;
    int terms;  ///< number of monomials
    int degree;  ///< largest degree of a monomial
    float inverse_film_radius, inverse_last_radius;  ///< scale x and p to at most 1
    float plane;  ///< z of the plane in which positions are stated, mm from the front vertex
    // Rims of the last and of the first surface: squared radius, mm^2, and sag at the rim, mm.
    float last_radius_squared, last_rim;
    float front_radius_squared, front_rim;
};

/// Result for a ray: its line in front of the lens, and its point in the stop.
struct LensPolynomialRay {
    Vec2f position;  ///< in the plane, mm
    Vec2f direction;  ///< x and y of the unit vector
    Vec2f at_stop;  ///< in radii of the stop
};

REALCAM_INLINE LensPolynomialRay evaluate(const LensPolynomialView& lens, Vec2f film, Vec2f last) {
    const Vec2f x = {lens.inverse_film_radius * film.x, lens.inverse_film_radius * film.y};
    const Vec2f p = {lens.inverse_last_radius * last.x, lens.inverse_last_radius * last.y};
    const float u = x.x * x.x + x.y * x.y, v = p.x * p.x + p.y * p.y, w = x.x * p.x + x.y * p.y;
    constexpr int kSums = 2 * LensPolynomialView::kVectors;
    float sums[kSums] = {};
    const float* next = lens.coefficients;
    float of_u = 1.0f;
    for (int i = 0; i <= lens.degree; ++i, of_u *= u) {
        float of_v = of_u;
        for (int j = 0; i + j <= lens.degree; ++j, of_v *= v) {
            float product = of_v;
            for (int k = 0; i + j + k <= lens.degree; ++k, product *= w, next += kSums)
                for (int s = 0; s < kSums; ++s) sums[s] += product * next[s];
        }
    }
    const auto vector = [&](int i) {
        const float a = sums[2 * i], b = sums[2 * i + 1];
        return Vec2f{a * x.x + b * p.x, a * x.y + b * p.y};
    };
    return {vector(0), vector(1), vector(2)};
}

}  // namespace REALCAM_NAMESPACE
