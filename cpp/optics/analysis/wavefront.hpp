#pragma once
#include <array>

#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Where the reference sphere has its centre.
enum class SphereCentre {
    chief,     ///< where the chief ray crosses the film plane
    centroid,  ///< the centroid of the spot there
};

/// How far the reference sphere is from its centre: to where the chief ray meets what follows. Where the lens is not of
/// revolution, or the field is named by its film point, there is but one: the image of the stop by rays close to the
/// chief ray.
enum class ExitPupil {
    real,  ///< the axis, as in CODE V's listings; on the axis, as below
    paraxial,  ///< the plane of the paraxial exit pupil, as in OpticStudio
};

/// What is fitted to the optical path difference by least squares over the open stop, in the stop's coordinates x, y,
/// and taken away.
enum class Removed {
    nothing,
    tilt,  ///< 1, x, y
    focus,  ///< 1, x, y, x^2 + y^2
};

/// The wavefront of one object point, by real rays that fill the real stop.
///
/// W = (optical path of the chief ray - optical path of the ray) / wavelength, both from the object to the reference
/// sphere. It is positive where the wavefront is ahead of the sphere, so an undercorrected lens has a positive W040.
/// The sphere's radius is the distance from the chief ray's film point to the exit pupil on that ray (ExitPupil). The
/// radius R is in W by p^2 / 2R, p the ray's distance from the centre: another radius changes little, another centre
/// much.
struct Wavefront {
    FieldRays rays;
    std::vector<double> opd;  ///< W in waves; NaN where the ray does not pass
    Vec3d centre;  ///< of the reference sphere, mm, relative to the last vertex
    double reference_curvature;  ///< 1/mm; positive where the light runs from the pupil to the centre; 0: plane
    double rms;  ///< of W about its mean over the open stop, waves
    double peak_to_valley;  ///< waves
    double strehl;  ///< |mean of exp(2 pi i W)|^2
    double strehl_marechal;  ///< exp(-(2 pi rms)^2), Marechal's approximation in the form of V. N. Mahajan, 1983
};

namespace wavefront_detail {

/// One over the distance from the exit pupil to the point where the chief ray meets the film, along the ray.
double reference_curvature(const LensSystem& lens, double wavelength_nm, const FieldRays& rays, double film_distance,
                           ExitPupil exit_pupil);

/// Solves the normal equations of a least-squares fit, a symmetric positive matrix of order n, by Cholesky's method.
template <std::size_t N>
std::array<double, N> solve_normal(std::array<std::array<double, N>, N> a, std::array<double, N> b, std::size_t n) {
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = std::sqrt(a[j][j]);
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
        for (std::size_t k = 0; k < j; ++k) b[j] -= a[j][k] * b[k];
        b[j] /= a[j][j];
    }
    for (std::size_t j = n; j-- > 0;) {
        for (std::size_t i = j + 1; i < n; ++i) b[j] -= a[i][j] * b[i];
        b[j] /= a[j][j];
    }
    return b;
}

}  // namespace wavefront_detail

/// The wavefront of the rays of one object point, with its reference sphere centred on the film, whose vertex is put
/// `film_distance` mm behind the last one. Throws InputError where there is no reference sphere: the exit pupil lies in
/// the film, or a ray passes the centre at more than the sphere's radius. Also throws where a fit has too few rays.
/// Throws what `loop` throws to stop it.
Wavefront wavefront_of(const LensSystem& lens, double wavelength_nm, FieldRays rays, double film_distance,
                       SphereCentre centre, Removed removed, ExitPupil exit_pupil = ExitPupil::real,
                       const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
