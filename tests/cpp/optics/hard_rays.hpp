#pragma once
// Rays through a lens by every backend, held against the oracle.

#include <algorithm>
#include <string>
#include <vector>

#include "embree/lens_rays.hpp"
#include "hard_lenses.hpp"
#include "optics/pupil/pupil.hpp"
#include "oracle.hpp"
#include "pupil_region.hpp"
#include "trace_backends.hpp"

namespace realcam::test {

/// Rays from the film, a tenth of them outside the lens's pupil on each side; the same in float32 as in float64.
inline RayBatch rays_from_film(const LensSystem& lens, int count, Random& random) {
    RayBatch rays;
    const Pupil pupil(lens, half_diagonal(lens), fast_pupil_tracer());
    const double n = lens.indices(lens.wavelength_nm).back();
    const auto in_float32 = [](double v) { return static_cast<double>(static_cast<float>(v)); };
    // Relative to the last vertex, from where the trace starts.
    const double z = lens.last_vertex() + in_float32(lens.film_distance);
    while (static_cast<int>(rays.size()) < count) {
        const double r = pupil.image_radius() * std::sqrt(random()), azimuth = random.between(0, 2 * M_PI);
        const PupilRegion region(pupil.view(), r);
        const double l = region.centre + region.half_width * random.between(-1.1, 1.1);
        const double m = region.half_height * random.between(-1.1, 1.1);
        if (!(l * l + m * m < n * n)) continue;
        const double c = std::cos(azimuth), s = std::sin(azimuth);
        const Vec3d direction{l * c - m * s, l * s + m * c, -std::sqrt(n * n - l * l - m * m)};
        rays.add({in_float32(r * c), in_float32(r * s), z}, static_cast<Vec3d>(static_cast<Vec3f>(direction)));
    }
    return rays;
}

/// Reversed rays of those that have left the lens, starting a little in front of it.
inline RayBatch rays_back(const LensSystem& lens, const std::vector<OracleRay>& ends) {
    RayBatch rays;
    for (const OracleRay& end : ends) {
        if (end.status != RayStatus::ok) continue;
        const Vec3d d = rounded(end.direction), origin = rounded(end.origin) + 0.1 * lens.film_position() * d;
        rays.add(static_cast<Vec3d>(static_cast<Vec3f>(origin)), -static_cast<Vec3d>(static_cast<Vec3f>(d)));
    }
    return rays;
}

inline std::vector<OracleRay> oracle_rays(const LensSystem& lens, LightDirection way, const RayBatch& rays) {
    std::vector<OracleRay> ends;
    for (std::size_t i = 0; i < rays.size(); ++i)
        ends.push_back(oracle_trace(lens, way, rays.origins[i], rays.directions[i]));
    return ends;
}

/// Largest errors over many rays; lengths relative to the lens's scale.
struct RayErrors {
    double ray = 0;    ///< position on the last surface, direction, optical path
    double image = 0;  ///< position on the film; for rays to the scene, of the film point that they trace back to
    int decided_otherwise = 0, passed = 0;

    void take(const RayErrors& other) {
        ray = std::max(ray, other.ray);
        image = std::max(image, other.image);
        decided_otherwise += other.decided_otherwise;
        passed += other.passed;
    }
};

inline double size_of(const RealVector& v) {
    return static_cast<double>(length(v));
}

inline RealVector on_plane(const RealVector& o, const RealVector& d, const Real& z) {
    return o + ((z - o.z) / d.z) * d;
}

/// The lens with slightly larger openings, which pass rays that rounding moves over a rim.
inline LensSystem opened(LensSystem lens) {
    for (Surface& s : lens.surfaces) {
        s.clear_semi_diameter *= 1.001;
        s.inner_semi_diameter *= 0.999;
    }
    lens.stop_semi_diameter *= 1.001;
    return lens;
}

inline RayErrors errors_of(const TraceBackend& backend, const LensSystem& lens, LightDirection way,
                           const RayBatch& rays, const std::vector<OracleRay>& truth) {
    const BatchResult found = backend(lens, way, rays);
    const bool exact_type = backend.precision == Precision::float64;
    const double scale = scale_of(lens), edge = exact_type ? 1e-10 : 1e-4;  // nearer decisions are left open
    const RayTracer back(opened(lens), LightDirection::to_film);
    RayErrors errors;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const OracleRay& ray = truth[i];
        const bool finite = std::isfinite(length(found.origins[i])) && std::isfinite(length(found.directions[i])) &&
                            std::isfinite(found.optical_path[i]);
        if (!finite) errors.ray = errors.image = kInfinity;
        if (found.passed(i) != (ray.status == RayStatus::ok)) {
            errors.decided_otherwise += ray.clearance > edge;
            continue;
        }
        if (ray.status != RayStatus::ok) {
            // The surface at which a ray ends; the cause may be either of two that it has there.
            errors.decided_otherwise +=
                exact_type && ray.clearance > edge && found.surface_index[i] != ray.surface_index;
            continue;
        }
        ++errors.passed;
        const RealVector origin = exact(found.origins[i]), direction = exact(found.directions[i]);
        const double turn = size_of(direction - ray.direction);
        const double path = std::fabs(static_cast<double>(Real(found.optical_path[i]) - ray.optical_path));
        errors.ray = std::max({errors.ray, size_of(origin - ray.origin) / scale, turn, path / scale});
        // Rays that graze a surface at less than 6 degrees are left out: a rounding of their origin or direction in
        // front of it, negligible there, moves the hit along the surface by ten times as much or more.
        if (ray.clearance < 0.01) continue;
        double image = 0;
        if (way == LightDirection::to_film) {
            const Real film = lens.film_position();
            image = size_of(on_plane(origin, direction, film) - on_plane(ray.origin, ray.direction, film));
        } else {
            // In float64, which is held to the oracle here too; from in front of the first surface.
            const Vec3d start = found.origins[i] + 0.01 * scale * found.directions[i];
            image = length(back(start, -found.directions[i]).at(lens.film_position()) - rays.origins[i]);
        }
        errors.image = std::max(errors.image, image / scale);
    }
    return errors;
}

}  // namespace realcam::test
