#pragma once
#include <complex>

#include "../prescription/glass_resonances.hpp"
#include "../trace/lens_path.hpp"
#include "coated_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Power transmittance of the lens for unpolarised light along a ray.
struct RayTransmittance {
    RayStatus status;
    double traced;    ///< with the polarisation traced from surface to surface; 0 if the ray does not pass
    double averaged;  ///< product of the surfaces' means of s and p, as if the light were unpolarised at each of them
};

/// Polarisation ray tracing: propagates two orthogonal electric fields, which together represent unpolarised light, as
/// complex vectors in the frame of the surface, with the Fresnel or thin-film coefficients at each surface (R. A.
/// Chipman, "Polarization ray tracing", Opt. Eng. 34, 1636, 1995; G. Yun, K. Crabtree and R. A. Chipman, Appl. Opt. 50,
/// 2855, 2011: P = O' J O^-1). The squared fields are scaled to the power of the beam, also where its cross-section
/// changes.
class PolarisedTrace {
public:
    /// `surface_count`: traces only this number of surfaces, in the order of the light; negative: all. Throws
    /// InputError if an index is unknown at the wavelength.
    PolarisedTrace(const LensSystem& lens, LightDirection direction, double wavelength_nm, int surface_count = -1,
                   const PathEnds& ends = {});

    /// Returns the transmittance of a ray: `origin` in mm and a `direction` of any length, in the lens frame or in the
    /// entry frame of `ends`. The status of an invalid ray is bad_input.
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

    /// Returns the fields behind a surface. `to_s`, `to_p`: its complex amplitude coefficients for the two
    /// polarisations.
    static Fields across(const Fields& fields, Vec3d before, Vec3d after, Vec3d normal, Complex to_s, Complex to_p);

    /// Transforms ray and fields into the frame of the next surface.
    static void change(const FrameChange<double>& frame, LensRays<double, 1>& ray, Fields& fields);

    static Vec3d normal_at(const LensView<double>& lens, int index, Vec3d at);

    LensPath<double> path_;
    std::vector<std::optional<CoatedSurface>> surfaces_;
};

}  // namespace REALCAM_NAMESPACE
