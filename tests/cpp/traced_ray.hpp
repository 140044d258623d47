#pragma once
// One ray at a time through a lens, in double precision and in the lens frame (z from the front vertex).

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "io/lens/lens_file.hpp"
#include "optics/lens/focus.hpp"
#include "optics/lens/paraxial.hpp"
#include "optics/trace/lens_path.hpp"

namespace realcam::test {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct TracedRay {
    Vec3d origin, direction;
    double optical_path;
    RayStatus status;
    int surface_index;

    bool passed() const { return status == RayStatus::ok; }
    /// Intersection of the ray, as a straight line, with the plane at z.
    Vec3d at(double z) const { return origin + ((z - origin.z) / direction.z) * direction; }
};

class RayTracer {
public:
    RayTracer(const LensSystem& lens, LightDirection direction, double wavelength_nm)
        : path_(lens, direction, wavelength_nm) {
        const std::vector<double> n = lens.indices(wavelength_nm);
        entry_index_ = direction == LightDirection::to_film ? n.front() : n.back();
        exit_index_ = direction == LightDirection::to_film ? n.back() : n.front();
    }
    RayTracer(const LensSystem& lens, LightDirection direction) : RayTracer(lens, direction, lens.wavelength_nm) {}

    TracedRay operator()(Vec3d origin, Vec3d direction) const {
        LensRays<double, 1> ray;
        origin.z -= path_.entry_position;
        ray.origin.set(0, origin);
        ray.direction.set(0, entry_index_ * normalized(direction));
        ray.status[0] = 0;
        PathRecord<double, 1> record{};
        trace_lens(path_.view(), ray, record);
        Vec3d end = ray.origin[0], way = ray.direction[0];
        end.z += path_.exit_position;
        const auto status = static_cast<RayStatus>(ray.status[0]);
        // The core's directions have the length of the index. Not made a unit vector where the medium is known: tests
        // see a wrong length.
        way = (1 / (status == RayStatus::ok ? exit_index_ : length(way))) * way;
        return {end, way, record.optical_path[0], status, record.surface_index[0]};
    }

private:
    LensPath<double> path_;
    double entry_index_, exit_index_;
};

/// Numbers in [0, 1), the same on every machine.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double operator()() { return static_cast<double>(engine_() >> 5) * 0x1p-27; }
    double between(double low, double high) { return low + (high - low) * (*this)(); }

private:
    std::mt19937 engine_;
};

/// A random point of the last surface's clear aperture, lens frame, even in area as seen along the axis.
inline Vec3d point_on_last_surface(const LensSystem& lens, Random& random) {
    const Surface& last = lens.surfaces.back();
    const double r = last.clear_semi_diameter * std::sqrt(random()), a = random.between(0, 2 * M_PI);
    return {r * std::cos(a), r * std::sin(a), lens.last_vertex() + last.sag(r)};
}

inline Vec3d point_on_film(const LensSystem& lens, Random& random) {
    return {lens.film_width * (random() - 0.5), lens.film_height * (random() - 0.5), lens.film_position()};
}

/// A focus near the lens: its nearest, or ten focal lengths.
inline double near_focus(const LensSystem& lens) {
    if (lens.focusing.nearest_mm > 0) return lens.focusing.nearest_mm;
    return lens.film_position() + 10 * std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
}

inline Surface refracting(double radius_of_curvature, double thickness, Glass behind, double semi_diameter) {
    Surface s;
    s.curvature = radius_of_curvature == 0 ? 0 : 1 / radius_of_curvature;
    s.thickness = thickness;
    s.material = behind;
    s.clear_semi_diameter = semi_diameter;
    return s;
}

inline Surface stop_plane(double thickness, double semi_diameter) {
    Surface s;
    s.type = SurfaceType::stop;
    s.thickness = thickness;
    s.clear_semi_diameter = semi_diameter;
    return s;
}

/// Wide-open lens of these surfaces, which may overlap, as tests also trace rays through impossible lenses.
inline LensSystem lens_of(std::vector<Surface> surfaces) {
    LensSystem lens;
    lens.name = "test";
    lens.allow_overlap = true;
    lens.surfaces = std::move(surfaces);
    if (lens.stop_index() >= 0) lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    return lens;
}

/// A paraboloid mirror of focal length f with its stop at the vertex, and the film `defocus` mm behind the focus along
/// the light's direction.
inline LensSystem paraboloid(double f, double radius, double defocus = 0) {
    Surface mirror = refracting(-2 * f, 0, Glass::air(), 1.01 * radius);
    mirror.type = SurfaceType::mirror;
    mirror.conic = -1;
    LensSystem lens = lens_of({stop_plane(0, radius), mirror});
    lens.film_distance = -f - defocus;
    return lens;
}

}  // namespace realcam::test
