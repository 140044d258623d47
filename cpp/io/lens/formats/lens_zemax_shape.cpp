// Interprets the surface types of a .zmx file. The parameters are those of Zemax's manual.
#include "lens_zemax_shape.hpp"

#include <algorithm>
#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"

namespace realcam::io {

namespace {

double at(const std::map<int, double>& values, int number) {
    const auto found = values.find(number);
    return found == values.end() ? 0.0 : found->second;
}

bool any_parameter(const ZemaxSurface& s, int first, int last) {
    return std::any_of(s.parameters.begin(), s.parameters.end(),
                       [&](const auto& p) { return p.first >= first && p.first <= last && p.second != 0; });
}

/// Adds a term of the sag, value x^power, in the file's unit.
void add_term(ZemaxSurface& s, int power, double value, double unit) {
    if (value != 0) s.row.aspheric[power] += value * std::pow(unit, 1 - power);
}

double curvature_of(double radius, double unit) {
    return radius == 0 ? 0.0 : 1 / (unit * radius);
}

/// Number of extra terms, whose coefficients begin at the third extra datum, and the normalization radius, the second
/// one.
struct ExtraTerms {
    int count;
    double radius;
};

ExtraTerms extra_terms(const ZemaxSurface& s) {
    const double radius = at(s.extra, 2);
    return {static_cast<int>(std::clamp(at(s.extra, 1), 0.0, 300.0)), radius > 0 ? radius : 1};
}

std::string set_xy_terms(ZemaxSurface& s, double unit) {
    const auto [count, radius] = extra_terms(s);
    int i = 1, j = 0;
    for (int k = 0; k < count; ++k) {
        const double value = at(s.extra, 3 + k);
        if (value != 0 && i + j > kMaxXyDegree)
            return "a term of x and y of more than the power " + std::to_string(kMaxXyDegree);
        if (value != 0) s.row.form.xy.push_back({i, j, unit * value / std::pow(unit * radius, i + j)});
        if (i == 0)
            i = j + 1, j = 0;
        else
            --i, ++j;
    }
    return "";
}

std::string set_zernike_terms(ZemaxSurface& s, double unit, ZernikeOrder order) {
    const auto [count, radius] = extra_terms(s);
    ZernikeTerms terms{order, unit * radius, {}};
    for (int k = 0; k < count; ++k) terms.coefficients.push_back(unit * at(s.extra, 3 + k));
    while (!terms.coefficients.empty() && terms.coefficients.back() == 0) terms.coefficients.pop_back();
    if (!terms.coefficients.empty()) s.row.form.zernike = terms;
    for (int k = 1; k <= 8; ++k) add_term(s, 2 * k, at(s.parameters, k), unit);
    return any_parameter(s, 9, 300) ? "a decentre of Zernike terms" : "";
}

void set_break(ZemaxSurface& s, double unit) {
    const auto parameter = [&](int number) { return at(s.parameters, number); };
    s.row.before = zemax_break({unit * parameter(1), unit * parameter(2), 0},
                               {parameter(3), parameter(4), parameter(5)}, parameter(6) != 0);
    s.row.curvature = 0;
    s.glass.clear();
}

}  // namespace

Affine<double> zemax_break(Vec3d decentre, Vec3d tilt_deg, bool is_reversed) {
    if (!is_reversed) return SurfacePlacement{decentre, tilt_deg, false}.frame();
    const auto turn = [](Vec3d tilt) { return SurfacePlacement{{}, tilt, false}.frame(); };
    return turn({0, 0, tilt_deg.z}) * turn({0, tilt_deg.y, 0}) * turn({tilt_deg.x, 0, 0}) *
           SurfacePlacement{decentre, {}, false}.frame();
}

std::string set_zemax_shape(ZemaxSurface& s, double unit) {
    SurfaceForm& form = s.row.form;
    if (s.type == "STANDARD") return "";  // its parameters have no meaning
    if (s.type == "EVENASPH" || s.type == "ODDASPHE") {
        const int step = s.type == "EVENASPH" ? 2 : 1;
        for (const auto& [number, value] : s.parameters)
            if (number > 0) add_term(s, step * number, value, unit);
        return "";
    }
    if (s.type == "XASPHERE" || s.type == "XOSPHERE") {
        const int step = s.type == "XASPHERE" ? 2 : 1;
        const auto [count, radius] = extra_terms(s);
        for (int k = 1; k <= count; ++k) add_term(s, step * k, at(s.extra, 2 + k) / std::pow(radius, step * k), unit);
        return "";
    }
    if (s.type == "TOROIDAL") {
        form.base = BaseForm::toroid;
        form.curvature_x = curvature_of(at(s.parameters, 1), unit);
        for (const auto& [number, value] : s.parameters)
            if (number > 1) add_term(s, 2 * (number - 1), value, unit);
        return at(s.extra, 1) > 0 ? "Zernike terms on a toroid" : "";
    }
    if (s.type == "BICONICX") {
        form.base = BaseForm::biconic;
        form.curvature_x = curvature_of(at(s.parameters, 1), unit);
        form.conic_x = at(s.parameters, 2);
        return "";
    }
    if (s.type == "XPOLYNOM") return set_xy_terms(s, unit);
    if (s.type == "SZERNSAG") return set_zernike_terms(s, unit, ZernikeOrder::noll);
    if (s.type == "FZERNSAG") return set_zernike_terms(s, unit, ZernikeOrder::fringe);
    if (s.type == "COORDBRK") {
        set_break(s, unit);
        return "";
    }
    return "a surface of type " + printable(s.type).substr(0, 40);
}

void set_zemax_aperture(ZemaxSurface& s) {
    ApertureShape& shape = s.row.aperture_shape;
    const Vec2d offset = s.aperture_offset;
    if (offset != Vec2d{0, 0}) {
        // A decentred circle: it is stated only by its radii.
        if (shape.kind == ApertureOutline::circle && s.row.inner_semi_diameter > 0)
            shape.obscurations.push_back({false, {s.row.inner_semi_diameter, s.row.inner_semi_diameter}, {0, 0}, 0});
        s.row.inner_semi_diameter = 0;
        if (shape.kind == ApertureOutline::circle && !s.row.is_open_outside && s.row.blocks &&
            shape.obscurations.empty())
            shape.half = {s.row.clear_semi_diameter, s.row.clear_semi_diameter};
        shape.offset = shape.half.x > 0 ? offset : Vec2d{0, 0};
        for (Obscuration& piece : shape.obscurations) piece.offset = offset;
    }
    // An aperture set by the designer limits the light, and not the semi-diameter.
    if (const double reach = shape.reach(); reach > 0) s.row.clear_semi_diameter = reach;
    if (s.arms > 0)
        for (Obscuration arm : spider_arms(s.arms, s.arm_width, std::max(s.row.clear_semi_diameter, s.arm_width), 0)) {
            arm.offset = {arm.offset.x + offset.x, arm.offset.y + offset.y};
            shape.obscurations.push_back(arm);
        }
}

}  // namespace realcam::io
