#pragma once
// Laws that hold for every ray at every surface that it meets: the hit lies on the surface and inside the rim, and the
// ray obeys Snell's law; if the ray ends there, the reported cause is real.
//
// The bounds are backward errors: they allow the effect of `kRoundings` roundings of the numbers that enter a formula,
// so they hold at tangents and at the edges of hemispheres too. The longest chain of operations from a ray to a hit has
// about twenty.

#include <algorithm>

#include "findings.hpp"
#include "optics/trace/lens_trace.hpp"

namespace realcam::fuzz {

inline constexpr double kRoundings = 32;

/// One ray at one surface. The numbers of the core, exact in double.
struct Crossing {
    Vec3d before, along;  ///< origin relative to this vertex, and optical direction
    Vec3d at, after;
    double path;  ///< optical path from `before` to `at`
    RayStatus status;
};

template <class T>
class SurfaceLaws {
public:
    SurfaceLaws(const SurfaceView<T>& step, const Iris<T>& iris)
        : step_(step),
          iris_(iris),
          c_(step.curvature),
          q_(step.conic_factor),
          bend_(std::fabs(c_) * (1 + std::fabs(q_ - 1))) {}

    void check(const Crossing& ray) const {
        const bool on_surface = ray.status != RayStatus::missed && ray.status != RayStatus::no_convergence;
        // Squares of larger lengths overflow; such a ray is outside every rim.
        if (!(length(ray.at) < 1e30) || !(length(ray.before) < 1e30)) return;
        if (!on_surface) {
            if (!same(ray.at, ray.before)) broken("a ray that ended has moved", ray, 0, 0);
            if (!same(ray.after, ray.along)) broken("a ray that ended has turned", ray, 0, 0);
            if (step_.kind == SurfaceShape::asphere) {
                check_search(ray);
            } else {
                check_miss(ray);
            }
            return;
        }
        // Past the region of the search the surface is another, which nothing passes.
        const double r2 = ray.at.x * ray.at.x + ray.at.y * ray.at.y;
        if (step_.kind == SurfaceShape::asphere && r2 > static_cast<double>(step_.search_squared))
            return check_aperture(ray);
        if (r2 > 1e4 * static_cast<double>(step_.rim_squared)) return check_aperture(ray);  // lost, however far
        const Near near = step_.kind == SurfaceShape::asphere ? asphere_at(ray) : conic_at(ray);
        if (!(near.distance <= near.distance_bound))
            broken("a hit is not on the surface", ray, near.distance, near.distance_bound);
        check_path(ray);
        check_aperture(ray);
        if (ray.status != RayStatus::ok && !same(ray.after, ray.along))
            broken("a ray that ended has turned", ray, 0, 0);
        if (!(near.distance_bound * bend_ < 0.01)) return;  // nobody knows the normal
        if (ray.status == RayStatus::ok) check_refraction(ray, near);
        if (ray.status == RayStatus::total_internal_reflection) check_reflection(ray, near);
    }

private:
    static constexpr double eps = std::numeric_limits<T>::epsilon();
    /// Squares of smaller numbers underflow.
    static constexpr double tiny = std::numeric_limits<T>::digits == 24 ? 0x1p-63 : 0x1p-511;

    struct Near {
        double distance, distance_bound;  ///< distance of the hit from the surface, mm
        Vec3d normal;
        double normal_bound;  ///< radians
        double incidence_bound;  ///< of p . normal, over |p|
    };

    Near conic_at(const Crossing& ray) const {
        const Vec3d o = ray.before, at = ray.at;
        // The search for a conic starts in its vertex plane, which a ray nearly parallel to it crosses far out.
        const double detour = step_.kind == SurfaceShape::conic ? 10 * std::fabs(o.z) : 0;
        const double way = length(at - o) + 2 * detour, from = length(o) + detour;
        const Vec3d gradient{-c_ * at.x, -c_ * at.y, 1 - c_ * q_ * at.z};
        const double g = length(gradient);
        const double value = residual(at);
        // Sum of the magnitudes of the terms of A t^2 - 2 G t + F, and of o + t p.
        const double terms = bend_ * (from * from + dot(at, at) + way * way) + 2 * (std::fabs(o.z) + std::fabs(at.z)) +
                             2 * way * (1 + bend_ * from) + 2 * g * (from + way) + tiny;
        const double incidence = kRoundings * eps * (1 + bend_ * (from + way));  // of G - A t
        const double turn = kRoundings * eps * (1 + std::fabs(c_ * q_ * at.z) + bend_ * (from + way)) / g;
        return {std::fabs(value) / (2 * g), kRoundings * eps * terms / (2 * g), (1 / g) * gradient, turn,
                incidence / g + turn};
    }
    /// c (r^2 + (1 + k) z^2) - 2 z: twice the distance from the surface, times the length of the gradient.
    double residual(Vec3d at) const {
        const long double x = at.x, y = at.y, z = at.z, c = c_, q = q_;
        return static_cast<double>(c * (x * x + y * y + q * z * z) - 2 * z);
    }

    /// Profile of an asphere at one distance from the axis. `sizes` and `slope_sizes` are sums of the magnitudes of the
    /// polynomial's terms, which its rounding errors scale with.
    struct Profile {
        double sag, slope, root;  ///< slope: d sag / dr; root: of 1 - (1 + k) c^2 r^2
        double sizes, slope_sizes;
    };
    Profile profile_at(long double r2) const {
        const long double c = c_, root = std::sqrt(std::max(0.0L, 1 - q_ * c * c * r2)), r = std::sqrt(r2);
        const long double inverse = step_.inverse_search_squared, u = r2 * inverse, from_middle = u - 0.5L;
        long double polynomial = 0, derivative = 0, sizes = 0, slope_sizes = 0;
        for (int i = kMaxAsphericTerms - 1; i >= 0; --i) {
            const long double term = step_.aspheric[i];
            derivative = derivative * from_middle + polynomial;
            polynomial = polynomial * from_middle + term;
            // At most: |u - 1/2| is 1/2 at the rim.
            slope_sizes = slope_sizes / 2 + (2 + 2 * i) * std::fabs(term);
            sizes = sizes / 2 + std::fabs(term);
        }
        const long double slope = c * r / root + 2 * r * inverse * u * (2 * polynomial + u * derivative);
        return {static_cast<double>(c * r2 / (1 + root) + u * u * polynomial), static_cast<double>(slope),
                static_cast<double>(root), static_cast<double>(u * u * sizes),
                static_cast<double>(2 * r * inverse * u * slope_sizes)};
    }

    Near asphere_at(const Crossing& ray) const {
        const Vec3d o = ray.before, at = ray.at;
        const long double r2 = static_cast<long double>(at.x) * at.x + static_cast<long double>(at.y) * at.y;
        const Profile here = profile_at(r2);
        const double square = static_cast<double>(r2), r = std::sqrt(square);
        // Rounding of 1 - (1 + k) c^2 r^2, which the root makes large at the edge.
        const double edge = std::min(std::sqrt(kRoundings * eps), kRoundings * eps / here.root) *
                            (1 + std::fabs(q_) * c_ * c_ * square);
        // The search's tolerance knows the surface's own height too.
        const double axial = std::fabs(o.z) + std::fabs(at.z - o.z) + std::fabs(here.sag) +
                             static_cast<double>(step_.sag_max - step_.sag_min) / 16;
        const double lateral = std::fabs(here.slope) * (length(o) + length(at - o));
        // On a very steep part the height is uncertain by the rounding of the position times the slope.
        const double height = kRoundings * eps * (axial + lateral + here.sizes) + std::fabs(c_) * square * edge + tiny;
        // The slope of a steep part is unbounded, but the angle of its normal is not.
        const double angle = std::atan(here.slope);
        double turn = 0;
        for (const double side : {-kRoundings * eps, kRoundings * eps}) {
            const Profile moved = profile_at(r2 * (1 + side));
            turn = std::max(turn, std::fabs(std::atan(moved.slope + side * moved.slope_sizes) - angle));
            turn = std::max(turn, std::fabs(std::atan(moved.slope - side * moved.slope_sizes) - angle));
        }
        turn += kRoundings * eps;
        const Vec3d outwards = r > 0 ? (1 / r) * Vec3d{at.x, at.y, 0} : Vec3d{1, 0, 0};
        return {std::fabs(at.z - here.sag), height, std::cos(angle) * Vec3d{0, 0, 1} - std::sin(angle) * outwards, turn,
                turn};
    }

    void check_refraction(const Crossing& ray, const Near& near) const {
        const double p = length(ray.along), out = length(ray.after),
                     n = std::sqrt(1 + static_cast<double>(step_.squared_index_change));
        const Vec3d change = ray.after - ray.along;
        const double turned = length(cross(change, near.normal));
        // A sphere's normal (-cx, -cy, 1 - cz) is not normalised: it has unit length only if the hit is on the sphere.
        const double stretch = step_.kind == SurfaceShape::sphere ? 2 * bend_ * near.distance_bound : 0;
        const double length_bound = kRoundings * eps * (p + n * p) +
                                    length(change) * (p * near.incidence_bound + length(change) * stretch) / out;
        // Restoring the length of the direction also changes its component along the surface.
        const double turn_bound = length(change) * near.normal_bound + kRoundings * eps * (p + out) + length_bound;
        if (!(turned <= turn_bound)) broken("Snell's law: the change is not along the normal", ray, turned, turn_bound);
        const double length_error = std::fabs(out - n * p);
        if (!(length_error <= length_bound))
            broken("Snell's law: the length is not the index", ray, length_error, length_bound);
        const double direction_sign_in = dot(ray.along, near.normal) * static_cast<double>(step_.direction_sign_in);
        const double direction_sign_out = dot(ray.after, near.normal) * static_cast<double>(step_.direction_sign_out);
        const double bound = p * near.incidence_bound + turn_bound;
        if (!(direction_sign_in >= -bound))
            broken("the surface is crossed in the wrong direction", ray, direction_sign_in, bound);
        if (!(direction_sign_out >= -bound)) broken("light leaves on the wrong side", ray, direction_sign_out, bound);
    }

    void check_reflection(const Crossing& ray, const Near& near) const {
        const double p2 = dot(ray.along, ray.along), step = static_cast<double>(step_.squared_index_change);
        const double along = dot(ray.along, near.normal), radicand = along * along + step * p2;
        const double bound = kRoundings * eps * (along * along + std::fabs(step) * p2) + 4 * p2 * near.incidence_bound;
        if (!(radicand <= bound)) broken("total reflection below the critical angle", ray, radicand, bound);
    }

    void check_path(const Crossing& ray) const {
        const double n = std::sqrt(static_cast<double>(step_.index_squared));
        const Vec3d moved = ray.at - ray.before;
        const double way = std::copysign(length(moved), dot(moved, ray.along));
        const double error = std::fabs(ray.path - n * way);
        // n^2 t is the path of a direction whose length is n.
        const double p = length(ray.along), stretched = std::fabs(way * (p - n) * n / p);
        const double bound = kRoundings * eps * n * (std::fabs(way) + length(ray.before)) + stretched + tiny;
        if (!(error <= bound)) broken("the optical path is not the way", ray, error, bound);
    }

    void check_aperture(const Crossing& ray) const {
        const double r2 = ray.at.x * ray.at.x + ray.at.y * ray.at.y;
        const double rim = static_cast<double>(step_.rim_squared), hole = static_cast<double>(step_.hole_squared);
        constexpr double least = 1 - 4 * eps, most = 1 + 4 * eps;
        double open_most = -1, open_least = -1, scale = 0;
        if (step_.has_blades) open_least = open_most = blades(ray.at, scale);
        open_least -= scale, open_most += scale;
        if (ray.status == RayStatus::vignetted) {
            if (r2 < least * rim && (hole < 0 || r2 > most * hole) && open_most < 0)
                broken("vignetted inside the rim", ray, r2, rim);
        } else {
            if (!(r2 <= most * rim + tiny)) broken("passed outside the rim", ray, r2, rim);
            if (!(r2 >= least * hole)) broken("passed inside the hole", ray, r2, hole);
            if (ray.status == RayStatus::ok && open_least > 0) broken("passed behind a blade", ray, open_least, scale);
        }
    }
    /// Returns a number that is positive behind a blade. `scale`: receives the bound of its rounding error.
    double blades(Vec3d at, double& scale) const {
        const double h = static_cast<double>(iris_.apothem), k = static_cast<double>(iris_.curvature);
        double extent = -1e300;
        for (int i = 0; i < iris_.blades; ++i)
            extent =
                std::max(extent, at.x * static_cast<double>(iris_.cos[i]) + at.y * static_cast<double>(iris_.sin[i]));
        const double r2 = at.x * at.x + at.y * at.y;
        scale = kRoundings * eps * (k * (r2 + h * h) + 2 * (1 + k * h) * std::sqrt(r2) + 2 * h);
        return k * (r2 + h * h) + 2 * (1 - k * h) * extent - 2 * h;
    }

    /// Checks that a ray that clearly intersects a conic is not reported as missed. The rounding of the discriminant
    /// and of the near cap depends on the distance of the ray's origin; rays within 1/100 of either limit are left
    /// out.
    void check_miss(const Crossing& ray) const {
        using Long = long double;
        const Vec3d od = ray.before, pd = ray.along;
        const Long k = q_ - 1, c = c_, ox = od.x, oy = od.y, oz = od.z, px = pd.x, py = pd.y, pz = pd.z;
        const Long F = c * (ox * ox + oy * oy + oz * oz + k * oz * oz) - 2 * oz;
        const Long G = pz - c * (ox * px + oy * py + oz * pz + k * oz * pz);
        const Long A = c * (px * px + py * py + pz * pz + k * pz * pz);
        const Long discriminant = G * G - A * F;
        const double slope = 1 + bend_ * length(od), p2 = dot(pd, pd);
        const double squares = p2 * (slope * slope + bend_ * (bend_ * dot(od, od) + 2 * std::fabs(od.z)));
        if (!(discriminant > std::max(0.01, 1e3 * eps) * squares)) return;
        const Long s = static_cast<Long>(step_.direction_sign_in) * std::sqrt(discriminant);
        const bool same_sign = G * s >= 0;
        if (!same_sign && !(std::fabs(A) > 1e-3L * bend_ * p2)) return;  // the root that is far away
        const Long t = same_sign ? F / (G + s) : (G - s) / A;
        const Long gz = 1 - c * q_ * (oz + t * pz);
        const double reach = length(od) + std::fabs(static_cast<double>(t)) * std::sqrt(p2);
        if (!(reach < 1e6 * std::sqrt(static_cast<double>(step_.rim_squared)))) return;
        if (gz > 0.01L && gz > 1e4L * static_cast<Long>(eps) * (1 + bend_ * static_cast<Long>(reach)))
            broken("a surface that is met counts as missed", ray, static_cast<double>(gz),
                   static_cast<double>(discriminant));
    }

    /// A ray that enters the rim's cylinder on the near side of an asphere and leaves it on the far side crosses it.
    void check_search(const Crossing& ray) const {
        const Vec3d o = ray.before, p = ray.along;
        const double across = p.x * p.x + p.y * p.y, rim = std::sqrt(static_cast<double>(step_.rim_squared));
        const double middle = -(o.x * p.x + o.y * p.y) / across, x = o.x + middle * p.x, y = o.y + middle * p.y;
        const double room = 0.99 * rim * rim - x * x - y * y;
        if (!(across > 1e-12 * dot(p, p)) || !(room > 0.01 * rim * rim) || !(length(o) < 100 * rim)) return;
        const double half = std::sqrt(room / across), sense = static_cast<double>(step_.direction_sign_in);
        const auto beyond = [&](double t) {
            const Vec3d at = o + t * p;
            const auto r2 = static_cast<T>(at.x * at.x + at.y * at.y);
            return sense * (at.z - static_cast<double>(asphere_sag(step_, r2).height));
        };
        // Outside the search radius the surface continues as a plane. A ray that hits the edge may cross either.
        const double to_edge = (static_cast<double>(step_.sag_edge) - o.z) / p.z;
        const double ex = o.x + to_edge * p.x, ey = o.y + to_edge * p.y,
                     search = static_cast<double>(step_.search_squared);
        if (std::fabs(ex * ex + ey * ey - search) < 1e-4 * search) return;
        const double near = beyond(middle - half), far = beyond(middle + half), clear = 1e-3 * rim;
        if (!(near < -clear && far > clear)) return;
        double low = middle - half, high = middle + half;
        for (int i = 0; i < 60; ++i) (beyond(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
        const Vec3d at = o + high * p;
        const double slope = profile_at(at.x * at.x + at.y * at.y).slope, r = std::hypot(at.x, at.y);
        const double inwards = sense * (p.z - slope * (at.x * p.x + at.y * p.y) / std::max(r, tiny));
        // At grazing incidence several intersections may lie within the rounding of one; any may determine the sense.
        if (inwards > 1e-3 * length(p)) broken("an asphere that is met counts as missed", ray, near, far);
    }

    static bool same(Vec3d a, Vec3d b) { return length(a - b) <= 4 * eps * length(b) + tiny; }

    __attribute__((noinline, cold)) void broken(const char* what, const Crossing& ray, double error,
                                                double bound) const {
        report(
            what,
            "%s, kind %d, c %.17g, 1+k %.17g, sense %g to %g, n'^2/n^2-1 %.17g, rim^2 %.9g; o (%.17g %.17g %.17g), p "
            "(%.17g %.17g %.17g), at (%.17g %.17g %.17g), p' (%.17g %.17g %.17g), path %.17g, status %d: %.6g, bound "
            "%.6g",
            eps < 1e-10 ? "float64" : "float32", static_cast<int>(step_.kind), c_, q_,
            static_cast<double>(step_.direction_sign_in), static_cast<double>(step_.direction_sign_out),
            static_cast<double>(step_.squared_index_change), static_cast<double>(step_.rim_squared), ray.before.x,
            ray.before.y, ray.before.z, ray.along.x, ray.along.y, ray.along.z, ray.at.x, ray.at.y, ray.at.z,
            ray.after.x, ray.after.y, ray.after.z, ray.path, static_cast<int>(ray.status), error, bound);
    }

    const SurfaceView<T>& step_;
    const Iris<T>& iris_;
    double c_, q_, bend_;
};

}  // namespace realcam::fuzz
