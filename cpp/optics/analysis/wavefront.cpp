#include "wavefront.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "../lens/paraxial.hpp"
#include "spot.hpp"

namespace realcam {

namespace wavefront_detail {

double reference_curvature(const LensSystem& lens, double wavelength_nm, const FieldRays& rays, double film_distance,
                           ExitPupil exit_pupil) {
    const Vec3d direction = normalized(rays.chief.direction);
    const Vec3d image = rays.on_film(rays.chief, film_distance);
    if (rays.exit_pupil_distance)
        return 1 / (*rays.exit_pupil_distance + (film_distance - lens.film_distance) / direction.z);
    // A chief ray on the axis has no crossing with it. At 1e-6 rad the crossing is within 1e-12 of the paraxial one,
    // which is the rounding error of the quotient below.
    if (exit_pupil == ExitPupil::paraxial || std::fabs(rays.field_angle_rad) < 1e-6) {
        const double pupil = first_order(lens, wavelength_nm).exit_pupil_position - lens.last_vertex();
        return direction.z / (image.z - pupil);
    }
    // With t the distance along the ray from the axis, image.y = t direction.y.
    return direction.y / image.y;
}

namespace {

/// Returns the optical path of a ray to the reference sphere, mm, minus a length that is common to all rays. b is the
/// vector from the centre to the ray's origin, d the ray's unit direction, p its distance from the centre, and R the
/// radius of the sphere. The ray hits the sphere at the distance -b.d - sqrt(R^2 - p^2) from its origin. R is added in
/// a form without cancellation, which is also valid for a plane.
double path_to_sphere(const AimedRay& ray, Vec3d centre, double curvature, double index) {
    const Vec3d d = normalized(ray.direction), b = ray.origin - centre, perpendicular = cross(b, d);
    const double square = dot(perpendicular, perpendicular) * curvature;
    return ray.path + index * (square / (1 + std::sqrt(1 - square * curvature)) - dot(b, d));
}

/// Fits the terms to the optical path difference and subtracts them. Throws InputError if there are too few rays.
void remove_fit(Wavefront& wavefront, Removed removed, const RayLoop& loop) {
    const std::size_t terms = removed == Removed::focus ? 4 : 3;
    std::array<std::array<double, 4>, 4> matrix{};
    std::array<double, 4> right_side{};
    const auto basis = [](const PupilPoint& p) { return std::array<double, 4>{1, p.x, p.y, p.x * p.x + p.y * p.y}; };
    loop.in_order(wavefront.opd.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!wavefront.rays.passes(i)) continue;
            const PupilPoint& point = wavefront.rays.pattern[i];
            const std::array<double, 4> f = basis(point);
            for (std::size_t j = 0; j < terms; ++j) {
                for (std::size_t k = 0; k <= j; ++k) matrix[j][k] += point.weight * f[j] * f[k];
                right_side[j] += point.weight * f[j] * wavefront.opd[i];
            }
        }
    });
    const std::array<double, 4> fit = solve_normal(matrix, right_side, terms);
    if (!std::isfinite(fit[terms - 1]))
        throw InputError("the rays that pass are too few, or too close together, for a fit of tilt and focus");
    for (std::size_t i = 0; i < wavefront.opd.size(); ++i) {
        const std::array<double, 4> f = basis(wavefront.rays.pattern[i]);
        for (std::size_t j = 0; j < terms; ++j) wavefront.opd[i] -= fit[j] * f[j];
    }
}

/// Computes RMS, peak to valley, and Strehl ratios.
void compute_statistics(Wavefront& wavefront, const RayLoop& loop) {
    double weight = 0, sum = 0, low = kInfinity, high = -kInfinity, square = 0;
    std::complex<double> amplitude = 0;
    const auto for_passing = [&](auto&& f) {
        loop.in_order(wavefront.opd.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                if (wavefront.rays.passes(i)) f(wavefront.rays.pattern[i].weight, wavefront.opd[i]);
        });
    };
    for_passing([&](double point_weight, double w) {
        weight += point_weight;
        sum += point_weight * w;
        low = std::min(low, w);
        high = std::max(high, w);
        amplitude += std::polar(point_weight, 2 * std::numbers::pi * w);
    });
    for_passing(
        [&](double point_weight, double w) { square += point_weight * (w - sum / weight) * (w - sum / weight); });
    wavefront.rms = std::sqrt(square / weight);
    wavefront.peak_to_valley = high - low;
    wavefront.strehl = std::norm(amplitude / weight);
    wavefront.strehl_marechal = std::exp(-std::pow(2 * std::numbers::pi * wavefront.rms, 2));
}

}  // namespace

}  // namespace wavefront_detail

Wavefront wavefront_of(const LensSystem& lens, double wavelength_nm, FieldRays rays, double film_distance,
                       SphereCentre centre, Removed removed, ExitPupil exit_pupil, const RayLoop& loop) {
    using namespace wavefront_detail;
    Wavefront result{};
    result.centre = rays.on_film(rays.chief, film_distance);
    result.reference_curvature = reference_curvature(lens, wavelength_nm, rays, film_distance, exit_pupil);
    if (centre == SphereCentre::centroid) {
        const Vec2<double> centroid = spot_of(rays, film_distance, loop).centroid;
        result.centre = FilmSurface<double>{film_distance, rays.film_curvature}.point(centroid);
    }
    const double index = lens.indices(wavelength_nm).back(), curvature = result.reference_curvature;
    const double waves_per_mm = 1e6 / wavelength_nm;
    const double reference = path_to_sphere(rays.chief, result.centre, curvature, index);
    result.opd.assign(rays.rays.size(), std::numeric_limits<double>::quiet_NaN());
    loop.for_all(rays.rays.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!rays.passes(i)) continue;
            result.opd[i] = waves_per_mm * (reference - path_to_sphere(rays.rays[i], result.centre, curvature, index));
            if (!std::isfinite(result.opd[i]))
                throw InputError(
                    "no reference sphere from the exit pupil of lens \"" + lens.name +
                    "\" intersects all its rays: the image is too far out of focus, or lies in the exit pupil");
        }
    });
    result.rays = std::move(rays);
    if (removed != Removed::nothing) remove_fit(result, removed, loop);
    compute_statistics(result, loop);
    return result;
}

}  // namespace realcam
