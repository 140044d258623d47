#pragma once
#include <complex>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Plane films between two media at one wavelength, in the order in which the light meets them. Refractive indices are
/// n + ik, light going as exp(i (k x - omega t)), so that k > 0 absorbs.
struct FilmStack {
    struct Film {
        std::complex<double> index;
        double thickness_nm;
    };
    double wavelength_nm;
    double index_before;  ///< of the medium from which the light comes: real, for else a wave there has no power of its
                          ///< own
    std::vector<Film> films;
    std::complex<double> index_behind;
};

/// What one polarisation does at a coated surface.
struct SurfaceResponse {
    /// Coefficients of the electric field (Fresnel's). For p its direction is s x k on every wave, where s is the
    /// field's direction in the other polarisation and k the wave's. So at normal incidence r has opposite signs for s
    /// and p.
    std::complex<double> r, t;
    double reflectance, transmittance, absorptance;  ///< shares of the power through the surface
};

struct PolarisedResponse {
    SurfaceResponse s, p;

    /// Values for unpolarised light.
    double mean_reflectance() const { return (s.reflectance + p.reflectance) / 2; }
    double mean_transmittance() const { return (s.transmittance + p.transmittance) / 2; }
};

namespace thin_film_detail {

using Complex = std::complex<double>;

}  // namespace thin_film_detail

/// Reflection and transmission of a film stack by the characteristic matrix of F. Abeles (H. A. Macleod, Thin-Film
/// Optical Filters, chapter 2). `cosine`: of the angle of incidence, 0 to 1, in the medium from which the light comes.
PolarisedResponse response_of(const FilmStack& stack, double cosine);

}  // namespace REALCAM_NAMESPACE
