#include "form_checks.hpp"

#include <algorithm>
#include <cmath>

#include "lens_limits.hpp"
#include "lens_system.hpp"

namespace realcam {

namespace {

bool all_finite(const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// True if a positive length, mm, is within the limits of a prescription.
bool is_valid_length(double v) {
    return v >= kShortestRadius && v <= kLongest;
}

/// True if both coordinates, mm, are within the limits of a prescription.
bool is_valid_point(Vec2d v) {
    return std::fabs(v.x) <= kLongest && std::fabs(v.y) <= kLongest;
}

/// True if a coefficient of r^power exceeds kLargestCoefficient, or its term's sag at the rim exceeds kLongest. `rim`:
/// radius of the rim, mm.
bool is_too_large(double coefficient, double rim, int power) {
    return !(std::fabs(coefficient) <= kLargestCoefficient &&
             std::fabs(coefficient) * std::pow(rim, power) <= kLongest);
}

/// Returns the reason why a surface's sag terms are invalid; empty if they are valid.
std::string terms_error(const Surface& s) {
    const SurfaceForm& form = s.form;
    const double rim = s.clear_semi_diameter;
    if (form.radial.size() > static_cast<std::size_t>(kMaxRadialTerms))
        return "radial terms are supported up to r^" + std::to_string(kMaxRadialTerms);
    for (std::size_t i = 0; i < form.radial.size(); ++i)
        if (is_too_large(form.radial[i], rim, static_cast<int>(i) + 1))
            return "a radial term is too large: its coefficient exceeds 1e37, or the term exceeds 1e9 mm at the rim";
    for (const XyTerm& term : form.xy) {
        if (term.x < 0 || term.y < 0 || term.x + term.y > kMaxXyDegree)
            return "the powers of terms of x and y must be at least 0, with a sum of at most " +
                   std::to_string(kMaxXyDegree) + "; one has x^" + std::to_string(term.x) + " y^" +
                   std::to_string(term.y);
        if (is_too_large(term.coefficient, rim, term.x + term.y))
            return "a term of x and y is too large: its coefficient exceeds 1e37, or the term exceeds 1e9 mm at the "
                   "rim";
    }
    std::string why;
    for_each_present_terms(form, [&](const auto& terms) {
        if (!why.empty()) return;
        const std::string name = terms.words.name;
        if (!is_valid_length(terms.radius))
            why = "the radius of its " + name + " terms must be a positive length";
        else if (terms.coefficients.size() > static_cast<std::size_t>(terms.max_coefficients()))
            why = "has more " + name + " terms than " + std::to_string(terms.max_coefficients());
        else if (!all_finite(terms.coefficients))
            why = "a " + name + " coefficient is not a finite number";
        else
            why = terms.error(s);
    });
    return why;
}

/// Returns the reason why a surface's aperture shape is invalid; empty if it is valid.
std::string aperture_error(const Surface& s) {
    const ApertureShape& shape = s.aperture_shape;
    if (shape.kind == ApertureOutline::polygon) {
        if (shape.corners.size() < 3 || shape.corners.size() > static_cast<std::size_t>(kMaxApertureCorners))
            return "its aperture has " + std::to_string(shape.corners.size()) + " corners; expected 3 to " +
                   std::to_string(kMaxApertureCorners);
        for (const Vec2d& corner : shape.corners)
            if (!is_valid_point(corner)) return "the corners of its aperture must be points (x, y) within 1e9 mm";
    } else if (shape.kind != ApertureOutline::circle || shape.half != Vec2d{0, 0}) {
        if (!is_valid_length(shape.half.x) || !is_valid_length(shape.half.y))
            return "the half widths of its aperture must be positive lengths";
    }
    if (!is_valid_point(shape.offset)) return "the offset of its aperture must be two lengths";
    const ApertureBox box = shape.box(s.clear_semi_diameter);
    if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return "its aperture lies beyond its clear semi-diameter";
    if (shape.obscurations.size() > static_cast<std::size_t>(kMaxObscurations))
        return "has more obscurations than " + std::to_string(kMaxObscurations);
    for (const Obscuration& piece : shape.obscurations)
        if (!is_valid_length(piece.half.x) || !is_valid_length(piece.half.y) || !is_valid_point(piece.offset) ||
            !(std::fabs(piece.angle_deg) <= 1e6))
            return "an obscuration must have positive half widths, an offset of two lengths, and an angle";
    return "";
}

/// True if the sag is finite all over the clear aperture, on a grid of 65 x 65 points.
bool reaches_rim(const Surface& s) {
    constexpr int kHalf = 32;
    const double rim = s.clear_semi_diameter;
    const ApertureBox box = s.aperture_shape.box(rim);
    for (int i = 0; i <= 2 * kHalf; ++i)
        for (int j = 0; j <= 2 * kHalf; ++j) {
            double x = box.low.x + (box.high.x - box.low.x) * i / (2 * kHalf);
            double y = box.low.y + (box.high.y - box.low.y) * j / (2 * kHalf);
            const double r = std::sqrt(x * x + y * y), factor = r > rim ? rim / r : 1;  // moves the point to the rim
            if (!std::isfinite(s.sag(factor * x, factor * y))) return false;
        }
    return true;
}

}  // namespace

std::string form_error(const Surface& surface) {
    const SurfaceForm& form = surface.form;
    if (std::string why = aperture_error(surface); !why.empty()) return why;
    if (!surface.bends_light() && !form.adds_nothing()) return "a stop or an aperture must be a plane";
    if (!std::isfinite(form.curvature_x) || std::fabs(form.curvature_x) > 1 / kShortestRadius)
        return "its radius of curvature in x must be at least 1e-6 mm (leave it out for none)";
    if (!(std::fabs(form.conic_x) <= kLargestConic)) return "the conic in x must lie between -1e6 and 1e6";
    if (form.base == BaseForm::conic && (form.curvature_x != 0 || form.conic_x != 0))
        return "only a biconic or a toroid can have a radius of curvature or conic in x";
    if (form.base == BaseForm::toroid && form.conic_x != 0) return "a toroid cannot have a conic in x";
    if (std::string why = terms_error(surface); !why.empty()) return why;
    return form.adds_nothing() || reaches_rim(surface)
               ? ""
               : "does not extend over its whole clear aperture: its radii, conics or terms end it before";
}

void validate(const Surface& surface) {
    if (!std::isfinite(surface.curvature)) throw InputError("a surface's radius of curvature must not be 0");
    if (surface.aspheric.size() > static_cast<std::size_t>(kMaxAsphericTerms))
        throw InputError("a surface has more aspheric coefficients than " + std::to_string(kMaxAsphericTerms));
    if (const std::string why = form_error(surface); !why.empty()) throw InputError("a surface " + why);
}

}  // namespace realcam
