#pragma once
// The oracle: the same rays in 50 decimal digits, by other formulas than the core's. Intersections come from the
// implicit equation of the surface and the plain quadratic formula (or, for polynomials, from bisection), Snell's law
// from unit vectors and the quotient of the indices. What is rounded at the 50th digit needs no care about
// cancellation.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "optics/prescription/lens_system.hpp"
#include "optics/trace/lens_path.hpp"

namespace realcam::test {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

/// By Newton's method from long double's 19 digits, which each step doubles. cpp_bin_float's own finds one bit after
/// the other, and was two thirds of the time of test_ray_derivatives.
inline Real sqrt(const Real& v) {
    if (!(v > 1e-300 && v < 1e300)) return boost::multiprecision::sqrt(v);
    const Real start = 1 / std::sqrt(static_cast<long double>(v));
    const Real inverse = start + start * (1 - v * start * start) / 2, root = v * inverse;
    return root + inverse * (v - root * root) / 2;
}

struct RealVector {
    Real x, y, z;
};
inline RealVector exact(Vec3d v) {
    return {v.x, v.y, v.z};
}
inline Vec3d rounded(const RealVector& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline RealVector operator+(const RealVector& a, const RealVector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline RealVector operator-(const RealVector& a, const RealVector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline RealVector operator*(const Real& s, const RealVector& v) {
    return {s * v.x, s * v.y, s * v.z};
}
inline Real dot(const RealVector& a, const RealVector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline RealVector cross(const RealVector& a, const RealVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real length(const RealVector& v) {
    return sqrt(dot(v, v));
}
inline RealVector normalized(const RealVector& v) {
    return (1 / length(v)) * v;
}

/// The sag of a conic with an even polynomial, by the square of the distance from the axis.
template <class T>
struct OracleSag {
    T curvature, conic;
    std::vector<T> aspheric;

    T operator()(const T& r2) const {
        using std::sqrt;
        T polynomial = 0;
        for (std::size_t i = aspheric.size(); i-- > 0;) polynomial = polynomial * r2 + aspheric[i];
        return curvature * r2 / (1 + sqrt(1 - (1 + conic) * curvature * curvature * r2)) + r2 * r2 * polynomial;
    }
};

/// A surface in its own vertex frame.
class OracleSurface {
public:
    explicit OracleSurface(const Surface& surface)
        : c_(surface.curvature),
          k_(surface.conic),
          sag_{c_, k_, {surface.aspheric.begin(), surface.aspheric.end()}},
          long_sag_{surface.curvature, surface.conic, {surface.aspheric.begin(), surface.aspheric.end()}} {}

    bool is_polynomial() const { return !sag_.aspheric.empty(); }

    Real sag(const Real& r2) const { return sag_(r2); }
    Real sag_derivative(const Real& r2) const {  // by r^2
        Real value = 0;
        const std::vector<Real>& terms = sag_.aspheric;
        for (std::size_t i = terms.size(); i-- > 0;) value = value * r2 + (static_cast<int>(i) + 2) * terms[i];
        return c_ / (2 * sqrt(1 - (1 + k_) * c_ * c_ * r2)) + r2 * value;
    }
    /// Unit, towards the film, of the near cap.
    RealVector normal(const RealVector& at) const {
        const Real r2 = at.x * at.x + at.y * at.y;
        if (is_polynomial()) {
            const Real slope = 2 * sag_derivative(r2);
            return normalized({-slope * at.x, -slope * at.y, 1});
        }
        return normalized({-c_ * at.x, -c_ * at.y, 1 - c_ * (1 + k_) * at.z});
    }
    /// Signed distance of a point from the surface, to first order: exact enough for roundings.
    Real distance(const RealVector& at) const {
        const Real r2 = at.x * at.x + at.y * at.y;
        if (is_polynomial()) return (at.z - sag(r2)) * normal(at).z;
        const RealVector gradient{-c_ * at.x, -c_ * at.y, 1 - c_ * (1 + k_) * at.z};
        return -(c_ * (r2 + (1 + k_) * at.z * at.z) - 2 * at.z) / (2 * length(gradient));
    }

    /// Ray parameters at which o + t d crosses the near cap of a conic in the given direction. `discriminant`, of the
    /// quadratic with unit d: how far the ray is from being a tangent (its square root is the cosine times |gradient|).
    std::optional<Real> crossing(const RealVector& o, const RealVector& d, int direction_sign,
                                 Real* discriminant = nullptr) const {
        const Real a = c_ * (dot(d, d) + k_ * d.z * d.z);
        const Real b = c_ * (dot(o, d) + k_ * o.z * d.z) - d.z;
        const Real q = c_ * (dot(o, o) + k_ * o.z * o.z) - 2 * o.z;
        const Real radicand = b * b - a * q;
        if (discriminant) *discriminant = radicand;
        if (radicand < 0) return {};
        std::vector<Real> roots;
        if (a == 0) {
            if (b == 0) return {};
            roots = {-q / (2 * b)};
        } else {
            roots = {(-b - sqrt(radicand)) / a, (-b + sqrt(radicand)) / a};
        }
        for (const Real& t : roots) {
            const RealVector at = o + t * d;
            if (1 - c_ * (1 + k_) * at.z <= 0) continue;  // the far cap, or the other sheet
            if (dot(normal(at), d) * direction_sign > 0) return t;
        }
        return {};
    }

    /// All crossings of an asphere inside the rim in the right direction, in the order of the light: sign changes of z
    /// - sag over `steps` pieces of the ray's way through the rim's cylinder, bisected in long double and polished by
    /// Newton's method to all digits.
    std::vector<Real> crossings_inside(const RealVector& o, const RealVector& d, int direction_sign, double rim,
                                       int steps = 512) const {
        using Long = long double;
        const Long ox(o.x), oy(o.y), oz(o.z), dx(d.x), dy(d.y), dz(d.z);
        const auto beyond = [&](Long t) {
            const Long x = ox + t * dx, y = oy + t * dy;
            return direction_sign * (oz + t * dz - long_sag_(std::min(x * x + y * y, static_cast<Long>(rim) * rim)));
        };
        const Long across = dx * dx + dy * dy, middle = across > 0 ? -(ox * dx + oy * dy) / across : -oz / dz;
        const Long x = ox + middle * dx, y = oy + middle * dy;
        const Long room = static_cast<Long>(rim) * rim - x * x - y * y;
        std::vector<Real> found;
        if (room < 0) return found;
        // Along the axis there is no cylinder to leave: as far as the surface can reach.
        const Long half = std::min(across > 0 ? std::sqrt(room / across) : HUGE_VALL, 1000 * (std::fabs(oz) + rim));
        Long before = beyond(middle - half);
        for (int i = 1; i <= steps; ++i) {
            Long low = middle - half + 2 * half * (i - 1) / steps, high = middle - half + 2 * half * i / steps;
            const Long here = beyond(high);
            if (before < 0 && here >= 0) {
                for (int k = 0; k < 70; ++k) {
                    const Long split = (low + high) / 2;
                    (beyond(split) < 0 ? low : high) = split;
                }
                found.push_back(polished((low + high) / 2, o, d));
            }
            before = here;
        }
        return found;
    }

private:
    Real polished(Real t, const RealVector& o, const RealVector& d) const {
        for (int i = 0; i < 4; ++i) {
            const RealVector at = o + t * d;
            const Real r2 = at.x * at.x + at.y * at.y;
            const Real slope = d.z - 2 * sag_derivative(r2) * (at.x * d.x + at.y * d.y);
            if (slope == 0) break;
            t -= (at.z - sag(r2)) / slope;
        }
        return t;
    }

    Real c_, k_;
    OracleSag<Real> sag_;
    OracleSag<long double> long_sag_;
};

/// Snell's law for unit vectors, d' = mu d + (sqrt(1 - mu^2 (1 - cos^2)) - mu cos) N with N along the light; nothing
/// past the critical angle. A mirror turns the part along N.
inline std::optional<RealVector> oracle_refract(const RealVector& d, RealVector normal, const Real& before,
                                                const Real& after, bool mirror) {
    Real cosine = dot(d, normal);
    if (cosine < 0) {
        normal = Real(-1) * normal;
        cosine = -cosine;
    }
    if (mirror) return d - 2 * cosine * normal;
    const Real mu = before / after, radicand = 1 - mu * mu * (1 - cosine * cosine);
    if (radicand < 0) return {};
    return mu * d + (sqrt(radicand) - mu * cosine) * normal;
}

struct OracleRay {
    RealVector origin, direction;  ///< lens frame, on the last surface met; unit
    Real optical_path = 0;
    RayStatus status = RayStatus::ok;
    int surface_index = -1;
    /// How near a decision was: the smallest relative distance of the ray from a rim, a hole, a tangent or the critical
    /// angle on its way, 1 where all were far.
    double clearance = 1;
};

/// Traces a ray through a lens whose numbers are taken as exact. Round diaphragms only.
inline OracleRay oracle_trace(const LensSystem& lens, LightDirection way, Vec3d origin, Vec3d direction) {
    const int count = static_cast<int>(lens.surfaces.size());
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    std::vector<Real> z(1, Real(0));
    for (int i = 0; i + 1 < count; ++i) z.push_back(z.back() + lens.surfaces[static_cast<std::size_t>(i)].thickness);
    std::vector<int> direction_sign_before(static_cast<std::size_t>(count)),
        direction_sign_behind(static_cast<std::size_t>(count));
    int direction_sign = 1;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        direction_sign_before[i] = direction_sign;
        if (lens.surfaces[i].type == SurfaceType::mirror) direction_sign = -direction_sign;
        direction_sign_behind[i] = direction_sign;
    }
    OracleRay ray{exact(origin), normalized(exact(direction))};
    const auto near = [&](const Real& relative) {
        ray.clearance = std::min(ray.clearance, std::fabs(static_cast<double>(relative)));
    };
    for (int step = 0; step < count; ++step) {
        const auto i = static_cast<std::size_t>(way == LightDirection::to_film ? step : count - 1 - step);
        const bool forth = way == LightDirection::to_film;
        const Surface& surface = lens.surfaces[i];
        const OracleSurface shape(surface);
        const int in = forth ? direction_sign_before[i] : -direction_sign_behind[i];
        ray.surface_index = static_cast<int>(i);
        const RealVector o = ray.origin - RealVector{0, 0, z[i]};
        std::optional<Real> t;
        if (shape.is_polynomial()) {
            const auto all = shape.crossings_inside(o, ray.direction, in, 1.02 * surface.clear_semi_diameter, 128);
            if (!all.empty()) t = all.front();
        } else {
            Real discriminant;
            t = shape.crossing(o, ray.direction, in, &discriminant);
            near(discriminant);
        }
        if (!t) {
            ray.status = RayStatus::missed;
            return ray;
        }
        const RealVector at = o + *t * ray.direction;
        ray.origin = at + RealVector{0, 0, z[i]};
        const double before = forth ? n[i] : n[i + 1], after = forth ? n[i + 1] : n[i];
        ray.optical_path += before * *t;
        double rim = surface.clear_semi_diameter;
        if (surface.type == SurfaceType::stop) rim = std::min(rim, lens.stop_semi_diameter);
        const Real r = sqrt(at.x * at.x + at.y * at.y);
        near(r / rim - 1);
        if (surface.inner_semi_diameter > 0) near(r / surface.inner_semi_diameter - 1);
        if (r > rim || r < surface.inner_semi_diameter) {
            ray.status = RayStatus::vignetted;
            return ray;
        }
        const RealVector normal = shape.normal(at);
        const Real cosine = dot(normal, ray.direction), mu = Real(before) / after;
        near(1 - mu * mu * (1 - cosine * cosine));
        const auto bent = oracle_refract(ray.direction, normal, before, after, surface.type == SurfaceType::mirror);
        if (!bent) {
            ray.status = RayStatus::total_internal_reflection;
            return ray;
        }
        ray.direction = *bent;
    }
    return ray;
}

}  // namespace realcam::test
