#pragma once
// Rays for a lens from fuzz bytes: the ordinary ones, and those that a formula for intersections or refraction has to
// fear at the first surface that the light meets.

#include "bytes.hpp"
#include "optics/trace/lens_path.hpp"

namespace realcam::fuzz {

struct DrawnRay {
    Vec3d origin, direction;  ///< lens frame; the direction of any length
};

class RayDrawer {
public:
    RayDrawer(Bytes& in, const LensSystem& lens, const LensPath<double>& path)
        : in_(in),
          step_(path.view().surfaces[0]),
          surface_(lens.surfaces[static_cast<std::size_t>(step_.surface_index)]),
          entry_position_(path.entry_position) {}

    DrawnRay operator()() {
        DrawnRay ray = relative();
        ray.origin.z += entry_position_;
        return ray;
    }

private:
    /// Relative to the first vertex.
    DrawnRay relative() {
        const double size = surface_.clear_semi_diameter;
        switch (in_.below(28)) {
            case 0: return {{0, 0, in_.between(-2, 2) * size}, {0, 0, in_.sign()}};
            case 1: return through({0, 0, 0}, any_direction());
            case 2: return through({0, 0, surface_.curvature != 0 ? 1 / surface_.curvature : 1e9}, any_direction());
            case 3: return inclined(90);
            case 4: return inclined(89.9999);
            case 5: return inclined(90 - in_.sign() * in_.decades(-14, 1));
            case 6: return inclined(critical_angle());
            case 7: return {point(in_.unit()), any_direction()};
            case 8: {
                const DrawnRay ray = ordinary();
                return {ray.origin, -ray.direction};
            }
            case 9: return {ordinary().origin, {0, 0, in_.chance(128) ? 0.0 : -0.0}};
            case 10: return {ordinary().origin, in_.decades(-323, -290) * any_direction()};
            case 11: return {ordinary().origin, in_.decades(0, 308) * any_direction()};
            case 12: return from_far(3 + in_.below(17));
            case 13: return with_one_absurd(ordinary());
            case 14: return {{in_.any(), in_.any(), in_.any()}, {in_.any(), in_.any(), in_.any()}};
            case 15: return sideways();
            case 16: return {point(in_.nudged(1)), any_direction()};
            case 17: return through(point(in_.nudged(1)), any_direction());
            case 18: return through(point(in_.nudged(surface_.inner_semi_diameter / size)), any_direction());
            case 19: return {size * any_direction(), any_direction()};
            default: return ordinary();
        }
    }

    /// From in front of the surface to a point inside its rim.
    DrawnRay ordinary() {
        const double size = surface_.clear_semi_diameter;
        const Vec3d to = point(std::sqrt(in_.unit()));
        const double away = in_.decades(-1, 1.5) * size, aside = away * in_.decades(-3, 0);
        const Vec3d from{to.x + in_.between(-1, 1) * aside, to.y + in_.between(-1, 1) * aside,
                         to.z - step_.direction_sign_in * away};
        return {from, to - from};
    }
    DrawnRay through(Vec3d at, Vec3d direction) {
        const double away = in_.chance(32) ? 0 : in_.decades(-2, 2) * surface_.clear_semi_diameter;
        return {at - (direction.z * step_.direction_sign_in < 0 ? -away : away) * direction, direction};
    }
    /// Meets the surface under this angle of incidence, in the sense in which light crosses it.
    DrawnRay inclined(double angle_deg) {
        const Vec3d at = point(in_.unit()), n = normal(at);
        const Vec3d helper = std::fabs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
        const Vec3d u = normalized(cross(n, helper)), v = cross(n, u);
        const double turn = in_.chance(64) ? 0 : in_.between(0, 2 * M_PI), angle = angle_deg * (M_PI / 180);
        const Vec3d d = (std::sin(angle) * std::cos(turn)) * u + (std::sin(angle) * std::sin(turn)) * v +
                        (step_.direction_sign_in * std::cos(angle)) * n;
        const double away = in_.decades(-3, 2) * surface_.clear_semi_diameter;
        return {at - away * d, d};
    }
    double critical_angle() {
        const double squared = 1 + step_.squared_index_change;  // n'^2 / n^2
        const double sine = squared < 1 ? std::sqrt(squared) * (1 + in_.sign() * in_.decades(-17, -3)) : in_.unit();
        return std::asin(std::min(sine, 1.0)) * (180 / M_PI);
    }
    DrawnRay from_far(int decades) {
        const Vec3d to = point(in_.unit());
        Vec3d d = normalized(any_direction());
        if (d.z * step_.direction_sign_in < 0) d = -d;
        return {to - (std::pow(10.0, decades) * in_.between(0.1, 1)) * d, d};
    }
    DrawnRay sideways() {
        DrawnRay ray = ordinary();
        ray.direction.z = in_.chance(128) ? 0 : in_.sign() * in_.decades(-320, -3) * length(ray.direction);
        if (in_.chance(64)) ray.origin.z = 0;
        return ray;
    }
    DrawnRay with_one_absurd(DrawnRay ray) {
        double* numbers[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z,
                             &ray.direction.x, &ray.direction.y, &ray.direction.z};
        *numbers[in_.below(6)] = in_.any();
        return ray;
    }

    Vec3d any_direction() {
        const Vec3d d{in_.between(-1, 1), in_.chance(64) ? 0 : in_.between(-1, 1), in_.between(-1, 1)};
        return dot(d, d) > 0 ? d : Vec3d{0, 0, 1};
    }
    /// On the surface, at this share of the rim.
    Vec3d point(double share) {
        const double r = share * surface_.clear_semi_diameter;
        const double azimuth = in_.chance(64) ? 0 : in_.between(0, 2 * M_PI), z = surface_.sag(r);
        return {r * std::cos(azimuth), r * std::sin(azimuth), std::isfinite(z) ? z : surface_.sag(0.5 * r)};
    }
    Vec3d normal(Vec3d at) const {
        const double r2 = at.x * at.x + at.y * at.y;
        if (step_.kind == SurfaceShape::asphere) {
            const double slope = 2 * asphere_sag(step_, r2).derivative;
            return std::isfinite(slope) ? normalized(Vec3d{-slope * at.x, -slope * at.y, 1}) : Vec3d{0, 0, 1};
        }
        const double c = step_.curvature;
        return normalized(Vec3d{-c * at.x, -c * at.y, 1 - c * step_.conic_factor * at.z});
    }

    Bytes& in_;
    const SurfaceView<double> step_;
    const Surface& surface_;
    double entry_position_;
};

}  // namespace realcam::fuzz
