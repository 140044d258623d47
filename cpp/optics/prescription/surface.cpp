#include "surface.hpp"

#include <cmath>
#include <cstddef>

#include "../../math/hypotenuse.hpp"

namespace realcam {

std::string Surface::asymmetry() const {
    if (placement.tilt_deg != Vec3d{0, 0, 0}) return "is tilted";
    if (placement.decentre != Vec3d{0, 0, 0}) return "is decentred";
    if (const std::string why = form.asymmetry(); !why.empty()) return why;
    return aperture_shape.asymmetry();
}

namespace {

using form_detail::polynomial;

/// Returns the sum of the even aspheric terms, mm. `squared`: r^2, or y^2 for a toroid, mm^2.
double even_terms(const Surface& surface, double squared) {
    return squared * squared * polynomial(surface.aspheric, squared);
}

/// Returns the sag of the base shape with the even aspheric terms, mm.
double base_sag(const Surface& surface, double x, double y) {
    const double c = surface.curvature, q = (1 + surface.conic) * c * c;
    const SurfaceForm& form = surface.form;
    if (form.base == BaseForm::toroid) {
        const double section = c * y * y / (1 + std::sqrt(1 - q * y * y)) + even_terms(surface, y * y);
        // A circle about the line of rotation; its radius is reduced by the sag of the section. Lengths in units of 1 /
        // curvature_x.
        const double radius = 1 - form.curvature_x * section, across = form.curvature_x * x;
        return (section * (1 + radius) + across * x) / (1 + std::sqrt(radius * radius - across * across));
    }
    const double r2 = x * x + y * y, terms = even_terms(surface, r2);
    if (form.base == BaseForm::conic) return c * r2 / (1 + std::sqrt(1 - q * r2)) + terms;
    const double cx = form.curvature_x, qx = (1 + form.conic_x) * cx * cx;
    return (cx * x * x + c * y * y) / (1 + std::sqrt(1 - qx * x * x - q * y * y)) + terms;
}

}  // namespace

double Surface::sag(double x, double y) const {
    const double r2 = x * x + y * y;
    double z = base_sag(*this, x, y);
    if (form.adds_nothing()) return z;
    const double r = std::sqrt(r2);
    z += r * polynomial(form.radial, r);
    for (const XyTerm& term : form.xy) z += term.coefficient * std::pow(x, term.x) * std::pow(y, term.y);
    for_each_present_terms(form, [&](const auto& terms) { terms.add_sag(z, x, y, {curvature, conic}); });
    return z;
}

double Surface::vertex_curvature() const {
    double c = curvature;
    if (form.radial.size() > 1) c += 2 * form.radial[1];
    for_each_present_terms(form, [&](const auto& terms) { c += terms.vertex_curvature(); });
    return c;
}

namespace {

struct CosSin {
    double cos, sin;
};

/// Returns cosine and sine of an angle, exact for right angles, which occur in fold mirrors.
CosSin cos_sin(double degrees) {
    int quarters = 0;
    const double remainder = std::remquo(degrees, 90.0, &quarters);
    const double c = std::cos(remainder * kDegree), s = std::sin(remainder * kDegree);
    switch (quarters & 3) {
        case 0: return {c, s};
        case 1: return {-s, c};
        case 2: return {-c, -s};
        default: return {s, -c};
    }
}

/// Returns the angle in degrees of this sine and cosine, exact for 0 and all right angles.
double degrees_of(double sin, double cos) {
    if (sin == 0) return cos < 0 ? 180 : 0;
    if (cos == 0) return std::copysign(90.0, sin);
    return std::atan2(sin, cos) / kDegree;
}

}  // namespace

Affine<double> SurfacePlacement::frame() const {
    const CosSin a = cos_sin(tilt_deg.x), b = cos_sin(tilt_deg.y), c = cos_sin(tilt_deg.z);
    const Affine<double> about_x{{1, 0, 0}, {0, a.cos, a.sin}, {0, -a.sin, a.cos}, decentre},
        about_y{{b.cos, 0, -b.sin}, {0, 1, 0}, {b.sin, 0, b.cos}, {0, 0, 0}},
        about_z{{c.cos, c.sin, 0}, {-c.sin, c.cos, 0}, {0, 0, 1}, {0, 0, 0}};
    return about_x * about_y * about_z;
}

SurfacePlacement SurfacePlacement::from_frame(const Affine<double>& frame) {
    SurfacePlacement result;
    result.decentre = frame.origin;
    const double cos_y = hypotenuse(frame.x.x, frame.y.x);
    result.tilt_deg.y = degrees_of(frame.z.x, cos_y);
    constexpr double kGimbalLock = 1e-12;  // cosine of the tilt about y
    if (cos_y < kGimbalLock) {
        result.tilt_deg.x = degrees_of(frame.y.z, frame.y.y);
        return result;
    }
    result.tilt_deg.x = degrees_of(-frame.z.y, frame.z.z);
    result.tilt_deg.z = degrees_of(-frame.y.x, frame.x.x);
    return result;
}

Affine<double> inverse_motion(const Affine<double>& motion) {
    const Vec3d &x = motion.x, &y = motion.y, &z = motion.z;
    Affine<double> inverse{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}, {0, 0, 0}};
    inverse.origin = -inverse.direction(motion.origin);
    return inverse;
}

}  // namespace realcam
