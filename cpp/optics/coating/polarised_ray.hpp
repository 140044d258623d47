#pragma once
#include <complex>

#include "../prescription/glass_resonances.hpp"
#include "../trace/lens_path.hpp"
#include "coated_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Share of the power of unpolarised light that a ray keeps on its way through the lens.
struct RayTransmittance {
    RayStatus status;
    double traced;    ///< with its polarisation followed from surface to surface; 0 where the ray does not pass
    double averaged;  ///< product of the surfaces' means of s and p, as if the light were unpolarised at each of them
};

/// Traces rays with their polarisation: both electric fields of which unpolarised light consists, as complex vectors in
/// the frame of the surface, through Fresnel's or the films' coefficients at each surface (R. A. Chipman, "Polarization
/// ray tracing", Opt. Eng. 34, 1636, 1995; G. Yun, K. Crabtree and R. A. Chipman, Appl. Opt. 50, 2855, 2011: P = O' J
/// O^-1). The fields are scaled to have the power of the light as their squares, also where the light's cross-section
/// changes.
class PolarisedTrace {
public:
    /// `surface_count`: only the first so many surfaces that the light meets; negative: all. Throws InputError where an
    /// index is not known at that wavelength.
    PolarisedTrace(const LensSystem& lens, LightDirection direction, double wavelength_nm, int surface_count = -1,
                   const PathEnds& ends = {});

    /// Transmittance of a ray in the lens frame or that of the path's end, mm, with a direction of any length. Bad
    /// input ends as bad_input.
    RayTransmittance operator()(Vec3d origin, Vec3d direction) const;

private:
    using Complex = std::complex<double>;
    struct Field {
        Vec3d real, imaginary;
    };
    struct Fields {
        Field first, second;
    };

    static Complex along(const Field& field, Vec3d unit) { return {dot(field.real, unit), dot(field.imaginary, unit)}; }
    static double power(const Field& field) {
        return dot(field.real, field.real) + dot(field.imaginary, field.imaginary);
    }
    static Complex scaled_to_power(const SurfaceResponse& response);

    static Vec3d some_perpendicular(Vec3d unit);
    static Fields unpolarised(Vec3d direction);

    /// `to_s`, `to_p`: complex amplitudes of the surface for the two polarisations.
    static Fields across(const Fields& fields, Vec3d before, Vec3d after, Vec3d normal, Complex to_s, Complex to_p);

    /// Into the frame of the next surface.
    static void change(const FrameChange<double>& frame, LensRays<double, 1>& ray, Fields& fields);

    static Vec3d normal_at(const LensView<double>& lens, int index, Vec3d at);

    LensPath<double> path_;
    std::vector<std::optional<CoatedSurface>> surfaces_;
};

}  // namespace REALCAM_NAMESPACE
