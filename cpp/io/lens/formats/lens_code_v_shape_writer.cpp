#include <utility>

#include "../lens_form_terms.hpp"
#include "../lens_writers.hpp"
#include "lens_code_v_shape.hpp"

namespace realcam::io {

namespace {

constexpr int kXyDegree = 10;  // highest degree of SPS XYP
constexpr std::size_t kAnamorphicTerms = 4;

class ShapeWriter {
public:
    explicit ShapeWriter(const Surface& surface) : s_(surface), form_(surface.form) {}

    CodeVShape write() {
        if (s_.bends_light()) write_form();
        write_aperture();
        return std::move(result_);
    }

private:
    void line(const std::string& text) { result_.commands += "  " + text + '\n'; }
    void line(const std::string& word, double value) { line(word + ' ' + exact_number(value)); }
    void leave_out(const std::string& what) { result_.left_out.push_back(what); }

    void write_form() {
        if (const std::string terms = beyond_polynomials(form_); !terms.empty())
            leave_out("has " + terms + ", which realcam does not write to .seq files");
        const bool has_radial = !form_.radial.empty() || form_.forbes, has_xy = !form_.xy.empty() || form_.zernike;
        if (form_.base != BaseForm::conic) {
            if (has_radial || has_xy) leave_out("has terms beside its toroid or biconic, which CODE V's types lack");
            form_.base == BaseForm::toroid ? write_toroid() : write_biconic();
        } else if (has_xy) {
            write_polynomial();
        } else if (has_radial) {
            write_odd();
        } else if (s_.is_asphere() || s_.conic != 0) {
            line(s_.is_asphere() ? "ASP" : "CON");
            line("K", s_.conic);
            write_even();
        }
    }

    void write_even() {
        for (std::size_t k = 0; k < s_.aspheric.size(); ++k)
            if (s_.aspheric[k] != 0) line(std::string(1, "ABCDEFGH"[k]), s_.aspheric[k]);
    }

    void write_toroid() {
        line("YTO");
        line("CUX", form_.curvature_x);
        line("K", s_.conic);
        write_even();
    }

    void write_biconic() {
        line("AAS");
        line("CUX", form_.curvature_x);
        line("K", s_.conic);
        line("KX", form_.conic_x);
        for (std::size_t k = 0; k < s_.aspheric.size(); ++k) {
            if (s_.aspheric[k] == 0) continue;
            if (k < kAnamorphicTerms)
                line(std::string(1, "ABCD"[k]) + 'R', s_.aspheric[k]);
            else
                leave_out("has even terms of more than r^10, which CODE V's anamorphic asphere lacks");
        }
    }

    void write_polynomial() {
        if (has_odd_terms(s_)) leave_out("has odd terms of r beside those of x and y, which CODE V's types lack");
        line("SPS XYP");
        line("SCO K", s_.conic);
        bool is_too_high = false;
        for (const auto& [power, value] : xy_terms_of(s_)) {
            const auto [degree, y] = power;
            if (degree == 0)
                result_.constant = value;
            else if (degree > kXyDegree)
                is_too_high = true;
            else
                line("SCO C" + std::to_string(degree * (degree + 1) / 2 + y + 1), value);
        }
        if (is_too_high) leave_out("has terms of x and y of more than the power 10, which CODE V's polynomial lacks");
    }

    void write_odd() {
        line("SPS ODD");
        line("SCO K", s_.conic);
        for (const auto& [power, value] : radial_terms_of(s_)) line("SCO AR" + std::to_string(power), value);
    }

    void write_aperture() {
        const ApertureShape& shape = s_.aperture_shape;
        if (s_.type != SurfaceType::stop || !shape.is_plain())
            line(shape.is_plain() ? "CIR" : "CIR L'RIM'", s_.clear_semi_diameter);
        if (s_.inner_semi_diameter > 0) line("CIR OBS", s_.inner_semi_diameter);
        const auto sides = [&](char word, const std::string& label, Vec2d half) {
            line(std::string(1, word) + (word == 'R' ? "EX" : "LX") + label, half.x);
            line(std::string(1, word) + (word == 'R' ? "EY" : "LY") + label, half.y);
        };
        const auto place = [&](const std::string& label, Vec2d offset, double angle_deg) {
            if (offset.x != 0) line("ADX" + label, offset.x);
            if (offset.y != 0) line("ADY" + label, offset.y);
            if (angle_deg != 0) line("ARO" + label, angle_deg);
        };
        const std::string label = " L'OPEN'";
        if (shape.kind == ApertureOutline::polygon) {
            leave_out("has a polygonal aperture, which a .seq file has no words for");
        } else if (shape.half.x > 0) {
            if (shape.kind == ApertureOutline::circle)
                line("CIR" + label, shape.half.x);
            else
                sides(shape.kind == ApertureOutline::rectangle ? 'R' : 'E', label, shape.half);
            place(label, shape.offset, 0);
        }
        for (std::size_t i = 0; i < shape.obscurations.size(); ++i) {
            const Obscuration& piece = shape.obscurations[i];
            const std::string name = " L'OBS" + std::to_string(i + 1) + '\'';
            sides(piece.is_rectangle ? 'R' : 'E', " OBS" + name, piece.half);
            place(name, piece.offset, piece.angle_deg);
        }
    }

    const Surface& s_;
    const SurfaceForm& form_;
    CodeVShape result_;
};

}  // namespace

CodeVShape code_v_shape_of(const Surface& surface) {
    return ShapeWriter(surface).write();
}

std::string code_v_placement(const SurfacePlacement& placement) {
    if (placement.is_in_place()) return {};
    std::string text;
    const auto add = [&](const char* word, double value) {
        if (value != 0) text += std::string("  ") + word + ' ' + exact_number(value) + '\n';
    };
    add("XDE", placement.decentre.x);
    add("YDE", placement.decentre.y);
    add("ZDE", placement.decentre.z);
    // Alpha and beta are positive clockwise.
    add("ADE", -placement.tilt_deg.x);
    add("BDE", -placement.tilt_deg.y);
    add("CDE", placement.tilt_deg.z);
    return placement.returns ? text + "  DAR\n" : text;
}

}  // namespace realcam::io
