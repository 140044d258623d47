#include "../lens_form_terms.hpp"
#include "../lens_writers.hpp"
#include "lens_zemax_shape.hpp"

namespace realcam::io {

namespace {

std::string numbered(const char* word, int number, double value) {
    return std::string(word) + ' ' + std::to_string(number) + ' ' + exact_number(value);
}

/// Writes the number of terms, the normalization radius, and the coefficients.
void add_extra(ZemaxShape& shape, double radius, const std::vector<double>& coefficients) {
    shape.lines.push_back(numbered("XDAT", 1, static_cast<double>(coefficients.size())));
    shape.lines.push_back(numbered("XDAT", 2, radius));
    for (std::size_t k = 0; k < coefficients.size(); ++k)
        shape.lines.push_back(numbered("XDAT", static_cast<int>(k) + 3, coefficients[k]));
}

/// Returns the coefficients in the order x, y, x^2, x y, y^2, ...
std::vector<double> in_order(const std::vector<XyTerm>& terms, ZemaxShape& shape) {
    std::vector<double> list;
    for (const XyTerm& term : terms) {
        const int degree = term.x + term.y;
        if (degree == 0) {
            shape.left_out.push_back("has a constant term, which Zemax's extended polynomial lacks");
            continue;
        }
        const auto place = static_cast<std::size_t>(degree * (degree + 1) / 2 + term.y - 1);
        if (list.size() <= place) list.resize(place + 1, 0.0);
        list[place] = term.coefficient;
    }
    return list;
}

void set_type(ZemaxShape& shape, const Surface& s) {
    const SurfaceForm& form = s.form;
    const std::string beyond = beyond_polynomials(form);
    const bool has_radial = !form.radial.empty() || (form.forbes && form.forbes->kind == ForbesKind::con);
    const int parts = (form.base != BaseForm::conic ? 1 : 0) + (has_radial ? 1 : 0) + (form.xy.empty() ? 0 : 1) +
                      (form.zernike ? 1 : 0);
    if (!beyond.empty()) shape.left_out.push_back("has " + beyond + ", which realcam does not write to .zmx files");
    if (parts > 1)
        shape.left_out.push_back("has terms of several kinds, of which one type of Zemax has the first alone");
    const double radius_x = form.curvature_x == 0 ? 0 : 1 / form.curvature_x;
    if (form.base == BaseForm::toroid) {
        shape.type = "TOROIDAL";
        shape.lines = {numbered("PARM", 1, radius_x)};
        for (std::size_t k = 0; k < s.aspheric.size(); ++k)
            shape.lines.push_back(numbered("PARM", static_cast<int>(k) + 3, s.aspheric[k]));
        return;
    }
    if (form.zernike && form.zernike->order == ZernikeOrder::noll) shape.type = "SZERNSAG";
    if (form.zernike && form.zernike->order == ZernikeOrder::fringe) shape.type = "FZERNSAG";
    if (form.zernike) {
        for (std::size_t k = 0; k < s.aspheric.size() && k < 7; ++k)
            shape.lines.push_back(numbered("PARM", static_cast<int>(k) + 2, s.aspheric[k]));
        add_extra(shape, form.zernike->radius, form.zernike->coefficients);
        return;
    }
    if (has_radial) {
        shape.type = "XOSPHERE";
        std::vector<double> terms;
        for (const auto& [power, value] : radial_terms_of(s)) {
            terms.resize(static_cast<std::size_t>(power), 0.0);
            terms.back() = value;
        }
        add_extra(shape, 1, terms);
        return;
    }
    if (s.is_asphere()) shape.left_out.push_back("has even terms, which Zemax's type of this surface lacks");
    if (form.base == BaseForm::biconic) {
        shape.type = "BICONICX";
        shape.lines = {numbered("PARM", 1, radius_x), numbered("PARM", 2, form.conic_x)};
    } else if (!form.xy.empty()) {
        shape.type = "XPOLYNOM";
        add_extra(shape, 1, in_order(form.xy, shape));
    }
}

std::string half_widths(const char* word, Vec2d half) {
    return std::string(word) + ' ' + exact_number(half.x) + ' ' + exact_number(half.y);
}

void set_aperture(ZemaxShape& shape, const Surface& s) {
    const ApertureShape& aperture = s.aperture_shape;
    Vec2d offset = aperture.offset;
    const bool is_open = aperture.kind == ApertureOutline::circle && aperture.half.x == 0;
    if (aperture.kind == ApertureOutline::rectangle) shape.aperture = {half_widths("SQAP", aperture.half)};
    if (aperture.kind == ApertureOutline::ellipse) shape.aperture = {half_widths("ELAP", aperture.half)};
    if (aperture.kind == ApertureOutline::polygon)
        shape.left_out.push_back("has a polygonal aperture, which realcam does not write to .zmx files");
    if (aperture.kind == ApertureOutline::circle && !is_open)
        shape.aperture = {half_widths("CLAP", {s.inner_semi_diameter, aperture.half.x})};
    // In Zemax a surface has one aperture or one obscuration.
    const bool says_it = is_open && aperture.obscurations.size() == 1 && aperture.obscurations.front().angle_deg == 0;
    if (says_it) {
        const Obscuration& piece = aperture.obscurations.front();
        shape.aperture = {half_widths(piece.is_rectangle ? "SQOB" : "ELOB", piece.half)};
        offset = piece.offset;
    } else if (!aperture.obscurations.empty()) {
        shape.left_out.push_back("has obscurations that Zemax's one aperture of a surface does not say");
    }
    const bool is_ring = aperture.kind == ApertureOutline::circle && !is_open;
    if (s.inner_semi_diameter > 0 && !is_ring && !shape.aperture.empty())
        shape.left_out.push_back("has a disc in its aperture, which Zemax's one aperture of a surface does not say");
    if (offset != Vec2d{0, 0}) shape.aperture.push_back(half_widths("OBDC", offset));
}

}  // namespace

ZemaxShape zemax_shape_of(const Surface& surface) {
    ZemaxShape shape;
    shape.type = surface.bends_light() && surface.is_asphere() ? "EVENASPH" : "STANDARD";
    if (surface.bends_light() && !surface.form.is_none()) set_type(shape, surface);
    if (!surface.aperture_shape.is_plain()) set_aperture(shape, surface);
    return shape;
}

}  // namespace realcam::io
