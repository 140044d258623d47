#include "surface.hpp"

#include <cmath>
#include <cstddef>

namespace realcam {

std::string Surface::asymmetry() const {
    if (placement.tilt_deg != Vec3d{0, 0, 0}) return "is tilted";
    if (placement.decentre != Vec3d{0, 0, 0}) return "is decentred";
    if (const std::string why = form.asymmetry(); !why.empty()) return why;
    return aperture_shape.asymmetry();
}

namespace {

using form_detail::polynomial;

/// Even aspheric terms from the fourth power on; `squared` is r^2, or y^2 for a toroid.
double even_terms(const Surface& surface, double squared) {
    return squared * squared * polynomial(surface.aspheric, squared);
}

double base_sag(const Surface& surface, double x, double y) {
    const double c = surface.curvature, q = (1 + surface.conic) * c * c;
    const SurfaceForm& form = surface.form;
    if (form.base == BaseForm::toroid) {
        const double section = c * y * y / (1 + std::sqrt(1 - q * y * y)) + even_terms(surface, y * y);
        const double rest = 1 - form.curvature_x * section, across = form.curvature_x * x;
        return (section * (1 + rest) + across * x) / (1 + std::sqrt(rest * rest - across * across));
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
    if (form.is_none()) return z;
    const double r = std::sqrt(r2);
    z += r * polynomial(form.radial, r);
    for (const XyTerm& term : form.xy) z += term.coefficient * std::pow(x, term.x) * std::pow(y, term.y);
    over_terms(form, [&](const auto& terms) { z += terms.sag(x, y, {curvature, conic}); });
    return z;
}

double Surface::vertex_curvature() const {
    double c = curvature;
    if (form.radial.size() > 1) c += 2 * form.radial[1];
    over_terms(form, [&](const auto& terms) { c += terms.vertex_curvature(); });
    return c;
}

}  // namespace realcam
