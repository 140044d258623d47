#pragma once
#include <complex>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Plane films between two media at one wavelength, in the order of the light. Refractive indices are n + ik for waves
/// exp(i (k x - omega t)), so that a positive imaginary part absorbs.
struct FilmStack {
    struct Film {
        std::complex<double> index;
        double thickness_nm;  ///< physical thickness
    };
    double wavelength_nm;
    double index_before;  ///< index of the incident medium: real, since in an absorbing medium the incident wave has no
                          ///< power of its own
    std::vector<Film> films;
    std::complex<double> index_behind;
};

/// Response of a coated surface to one polarisation.
struct SurfaceResponse {
    /// Amplitude coefficients of the electric field (Fresnel's). The direction of the p field is s x k on every wave,
    /// where s is the direction of the s field and k that of the wave. So at normal incidence r has opposite signs for
    /// s and p.
    std::complex<double> r, t;
    double reflectance, transmittance, absorptance;  ///< fractions of the incident power
};

/// Response to both polarisations: perpendicular (s) and parallel (p) to the plane of incidence.
struct PolarisedResponse {
    SurfaceResponse s, p;

    /// Reflectance and transmittance for unpolarised light.
    double mean_reflectance() const { return (s.reflectance + p.reflectance) / 2; }
    double mean_transmittance() const { return (s.transmittance + p.transmittance) / 2; }
};

namespace thin_film_detail {

using Complex = std::complex<double>;

}  // namespace thin_film_detail

/// Returns the reflection and transmission of a film stack by the characteristic matrix of F. Abeles (H. A. Macleod,
/// Thin-Film Optical Filters, chapter 2). `cosine`: cosine of the angle of incidence, 0 to 1, in the incident medium.
PolarisedResponse response_of(const FilmStack& stack, double cosine);

}  // namespace REALCAM_NAMESPACE
