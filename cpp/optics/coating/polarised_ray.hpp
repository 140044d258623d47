#pragma once
#include <complex>

#include "../prescription/glass_resonances.hpp"
#include "../trace/lens_path.hpp"
#include "coated_surface.hpp"

namespace REALCAM_NAMESPACE {

/// Power transmittance of the lens for unpolarised light along a ray.
struct RayTransmittance {
    RayStatus status;
    double traced;  ///< with the polarisation traced from surface to surface; 0 if the ray does not pass
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
    /// Complex electric field, perpendicular to the ray.
    struct Field {
        Vec3d real, imaginary;
    };
    /// The two fields that together represent unpolarised light.
    struct Fields {
        Field first, second;
    };

    /// Component of a field along a unit vector.
    static Complex along(const Field& field, Vec3d unit) { return {dot(field.real, unit), dot(field.imaginary, unit)}; }
    static double power(const Field& field) {
        return dot(field.real, field.real) + dot(field.imaginary, field.imaginary);
    }
    /// Returns the amplitude coefficient of transmission with its absolute value replaced by the root of the
    /// transmittance.
    static Complex scaled_to_power(const SurfaceResponse& response);

    /// Returns a unit vector perpendicular to a unit vector.
    static Vec3d some_perpendicular(Vec3d unit);
    /// Returns two orthogonal fields of power 1 for a ray in this unit direction.
    static Fields unpolarised(Vec3d direction);

    /// Returns the fields behind a surface. `before`, `after`: unit directions of the ray; `s_coefficient`,
    /// `p_coefficient`: the surface's complex amplitude coefficients for the two polarisations.
    static Fields behind_surface(const Fields& fields, Vec3d before, Vec3d after, Vec3d normal, Complex s_coefficient,
                                 Complex p_coefficient);

    /// Transforms ray and fields into the frame of the next surface.
    static void change_to_frame(const FrameChange<double>& frame, LensRays<double, 1>& ray, Fields& fields);

    /// Returns the unit normal of surface `index`, in the order of the light, at a point in its frame, mm.
    static Vec3d normal_at(const LensView<double>& lens, int index, Vec3d point);

    LensPath<double> path_;
    std::vector<std::optional<CoatedSurface>> surfaces_;
};

}  // namespace REALCAM_NAMESPACE
