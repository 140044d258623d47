#pragma once
#include "lens_rays.hpp"

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

    // The following members are used only for ray pairs (RayPairTable), whose rims are unknown.
    /// Coefficients of two scalars for each monomial, array of shape (terms, 2): z of the position, and z of a
    /// direction of any length. Null: positions lie in `plane`, and directions are unit vectors with z < 0.
    const float* heights;
    /// Coefficients of a and b of the point a x + b p, for each monomial with i + j + k <= kDiscDegree: array of shape
    /// (disc_count, kDiscTerms, 2). A ray passes if all its points lie inside the unit circle.
    const float* discs;
    int disc_count;

    static constexpr int kDiscDegree = 1;  ///< cubic points: circles that pupil aberrations of third order deform
    static constexpr int kDiscTerms = 4;  ///< number of monomials of degree kDiscDegree
};

/// Ray in front of the lens, towards the scene, and its point in the stop.
template <class T>
struct LensPolynomialRay {
    Vec3<T>
        position;  ///< mm from the front vertex; in the plane z = LensPolynomialView::plane unless there are heights
    Vec3<T> direction;  ///< unit vector; z is 0 if the polynomials give no direction
    Vec2<T> at_stop;  ///< in units of the radius of the stop; 0 for ray pairs
};

/// Film point x and point p of the plane of the last vertex, scaled to at most 1, and their dot products.
template <class T>
struct LensPolynomialArguments {
    Vec2<T> x, p;
    T u, v, w;  ///< x.x, p.p, x.p

    REALCAM_INLINE LensPolynomialArguments(const LensPolynomialView& lens, Vec2<T> film, Vec2<T> last)
        : x{static_cast<T>(lens.inverse_film_radius) * film.x, static_cast<T>(lens.inverse_film_radius) * film.y},
          p{static_cast<T>(lens.inverse_last_radius) * last.x, static_cast<T>(lens.inverse_last_radius) * last.y},
          u(x.x * x.x + x.y * x.y),
          v(p.x * p.x + p.y * p.y),
          w(x.x * p.x + x.y * p.y) {}

    /// a x + b p.
    REALCAM_INLINE Vec2<T> vector(T a, T b) const { return {a * x.x + b * p.x, a * x.y + b * p.y}; }
};

/// Returns the ray through a point of the film and one of the plane of the last vertex. Rims are not tested.
template <class T>
REALCAM_INLINE LensPolynomialRay<T> evaluate(const LensPolynomialView& lens, const LensPolynomialArguments<T>& at) {
    constexpr int kSums = 2 * LensPolynomialView::kVectors;
    T sums[kSums] = {};
    T z[2] = {};
    const float* next = lens.coefficients;
    const float* height = lens.heights;
    T power_u = 1;
    for (int i = 0; i <= lens.degree; ++i, power_u *= at.u) {
        T power_uv = power_u;
        for (int j = 0; i + j <= lens.degree; ++j, power_uv *= at.v) {
            T monomial = power_uv;
            for (int k = 0; i + j + k <= lens.degree; ++k, monomial *= at.w, next += kSums) {
                for (int s = 0; s < kSums; ++s) sums[s] += monomial * static_cast<T>(next[s]);
                if (!height) continue;
                for (int s = 0; s < 2; ++s) z[s] += monomial * static_cast<T>(*height++);
            }
        }
    }
    const Vec2<T> position = at.vector(sums[0], sums[1]), direction = at.vector(sums[2], sums[3]),
                  at_stop = at.vector(sums[4], sums[5]);
    const T squared = direction.x * direction.x + direction.y * direction.y;
    if (lens.heights) {
        const T scale = 1 / std::sqrt(squared + z[1] * z[1]);
        return {{position.x, position.y, z[0]}, {scale * direction.x, scale * direction.y, scale * z[1]}, at_stop};
    }
    return {{position.x, position.y, static_cast<T>(lens.plane)},
            {direction.x, direction.y, -sqrt_or_zero(1 - squared)},
            at_stop};
}

/// Returns the point of a disc of ray pairs, in units of its radius.
template <class T>
REALCAM_INLINE Vec2<T> disc_point(const LensPolynomialView& lens, int disc, const LensPolynomialArguments<T>& at) {
    static_assert(LensPolynomialView::kDiscDegree == 1 && LensPolynomialView::kDiscTerms == 4);
    const float* c = lens.discs + 2 * LensPolynomialView::kDiscTerms * disc;
    const auto sum = [&](int i) {
        return static_cast<T>(c[i]) + at.w * static_cast<T>(c[i + 2]) + at.v * static_cast<T>(c[i + 4]) +
               at.u * static_cast<T>(c[i + 6]);
    };
    return at.vector(sum(0), sum(1));
}

/// Replaces rays at the film, `film_distance` mm behind the last vertex, by those in front of the lens. Rays that meet
/// a rim or the stop, or, for ray pairs, that were not measured, get the status vignetted.
template <class T, int N>
REALCAM_HD inline void trace_polynomial(const LensPolynomialView& lens, T film_distance, LensRays<T, N>& rays) {
    const auto squared = [](T x, T y) { return x * x + y * y; };
    const auto last_radius_squared = static_cast<T>(lens.last_radius_squared),
               front_radius_squared = static_cast<T>(lens.front_radius_squared);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3<T> film = rays.origin[i], start = rays.direction[i];
        const T distance = film_distance / start.z, back = distance - static_cast<T>(lens.last_rim) / start.z;
        const LensPolynomialArguments<T> at(lens, {film.x, film.y},
                                            {film.x - distance * start.x, film.y - distance * start.y});
        const LensPolynomialRay<T> ray = evaluate(lens, at);
        bool passes = (squared(film.x - back * start.x, film.y - back * start.y) <= last_radius_squared) &
                      (squared(ray.at_stop.x, ray.at_stop.y) <= 1);
        if (lens.disc_count > 0) {
            passes &= at.u <= 1;
            for (int disc = 0; disc < lens.disc_count; ++disc) {
                const Vec2<T> point = disc_point(lens, disc, at);
                passes &= squared(point.x, point.y) <= 1;
            }
        } else {
            const T to_front = (static_cast<T>(lens.front_rim) - ray.position.z) / ray.direction.z;
            passes &=
                (ray.direction.z < 0) & (squared(ray.position.x + to_front * ray.direction.x,
                                                 ray.position.y + to_front * ray.direction.y) <= front_radius_squared);
        }
        rays.origin.set(i, ray.position);
        rays.direction.set(i, ray.direction);
        rays.status[i] = select(passes, rays.status[i], static_cast<int>(RayStatus::vignetted));
    }
}

}  // namespace REALCAM_NAMESPACE
