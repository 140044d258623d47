#pragma once
#include <array>

#include "field_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Centre of the reference sphere of a wavefront.
enum class SphereCentre {
    chief,  ///< intersection of the chief ray with the film
    centroid,  ///< centroid of the spot on the film
};

/// Exit pupil, whose distance from the centre is the radius of the reference sphere. The choice has no effect for a
/// lens without rotational symmetry, and for a field specified by its film point: the exit pupil is then the image of
/// the stop by rays close to the chief ray.
enum class ExitPupil {
    real,      ///< intersection of the chief ray with the axis, as in CODE V; for a field on the axis as `paraxial`
    paraxial,  ///< intersection of the chief ray with the plane of the paraxial exit pupil, as in OpticStudio
};

/// Terms that are fitted to the optical path difference by least squares over the rays that pass, in the coordinates x,
/// y of the stop, and subtracted.
enum class Removed {
    nothing,
    tilt,  ///< 1, x, y
    focus,  ///< 1, x, y, x^2 + y^2
};

/// Wavefront of one object point, from real rays that fill the real stop.
///
/// W = (optical path of the chief ray - optical path of the ray) / wavelength, both from the object to the reference
/// sphere. It is positive where the wavefront is ahead of the sphere, so an undercorrected lens has a positive W040.
/// The sphere's radius R is the distance from the chief ray's film point to the exit pupil on that ray (ExitPupil). It
/// enters W only through p^2 / 2R, with p the ray's distance from the centre: W depends little on the radius and
/// strongly on the centre.
struct Wavefront {
    FieldRays rays;
    std::vector<double> opd;  ///< W in waves; NaN if the ray does not pass
    Vec3d centre;  ///< centre of the reference sphere, mm, relative to the last vertex
    double reference_curvature;  ///< 1/mm; positive if the light travels from the pupil to the centre; 0: plane
    double rms;  ///< RMS of W about its mean over the open part of the stop, waves
    double peak_to_valley;  ///< largest minus smallest W, waves
    double strehl;  ///< |mean of exp(2 pi i W)|^2
    double strehl_marechal;  ///< exp(-(2 pi rms)^2), Marechal's approximation in the form of V. N. Mahajan, 1983
};

namespace wavefront_detail {

/// Returns the inverse distance from the exit pupil to the film point of the chief ray, along the ray, 1/mm.
double reference_curvature(const LensSystem& lens, double wavelength_nm, const FieldRays& rays, double film_distance,
                           ExitPupil exit_pupil);

/// Solves the normal equations a x = b of a least-squares fit by Cholesky's method. `a` must be symmetric and positive
/// definite; only its first n rows and columns, and only the lower triangle, are used. Elements of x from n on are
/// those of b.
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

/// Computes the wavefront of the rays of one object point, with its reference sphere centred on a film whose vertex
/// lies `film_distance` mm behind the last vertex. Throws InputError if there is no reference sphere (the exit pupil
/// lies in the film, or a ray passes the centre at more than the sphere's radius), or if a fit has too few rays, and
/// Cancelled if `loop` is cancelled.
Wavefront wavefront_of(const LensSystem& lens, double wavelength_nm, FieldRays rays, double film_distance,
                       SphereCentre centre, Removed removed, ExitPupil exit_pupil = ExitPupil::real,
                       const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
