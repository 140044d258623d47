// Surfaces of a .seq file other than spheres, conics and aspheres: toroids and cylinders (YTO, XTO, CYL), anamorphic
// aspheres (AAS) and special surfaces (SPS).

#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../lens_places.hpp"
#include "lens_code_v_reader.hpp"

namespace realcam::io {

void CodeVReader::read_special_kind(Words& words) {
    PrescriptionSurface& row = row_of(words);
    const std::string kind = words.size() > 1 ? upper_case(words[1].text.substr(0, 10)) : "";
    if (kind != "XYP" && kind != "ODD")
        return foreign("a special surface (SPS" + (kind.empty() ? "" : ' ' + printable(kind)) + ')');
    Special& special = specials_[row.number];
    special.kind = kind;
    if (words.size() > 2) special.radius = number(words, 2, "the normalization radius");
}

void CodeVReader::read_special_term(Words& words) {
    PrescriptionSurface& row = row_of(words);
    const auto found = specials_.find(row.number);
    if (words.size() < 3) lines_.fail("SCO needs the coefficient's name and its value");
    const std::string name = upper_case(words[1].text.substr(0, 20));
    const double value = number(words, 2, "the coefficient");
    if (found == specials_.end()) return;  // of an unsupported kind, which is recorded
    Special& special = found->second;
    const bool is_odd = special.kind == "ODD";
    const auto rest = [&](std::size_t letters) { return std::string_view(name).substr(letters); };
    if (name == "K" || name == "C1") {
        row.conic = value;
    } else if (name == "NRADIUS" || (is_odd && name == "C33")) {
        special.radius = value;
    } else if (is_odd && name.starts_with("AR") && is_digits(rest(2))) {
        special.terms[lines_.whole_number_of(rest(2), "the power of r", 1, 30)] = value;
    } else if (name.starts_with('C') && is_digits(rest(1))) {
        // C2 is the first term: that of r, or of x.
        const int last = is_odd ? 31 : (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;
        special.terms[lines_.whole_number_of(rest(1), "the number of the coefficient", 2, last) - 1] = value;
    } else {
        foreign("a coefficient of a special surface (SCO " + printable(name) + ')');
    }
}

void CodeVReader::read_anamorphic_term(const std::string& word, Words& words) {
    PrescriptionSurface& row = row_of(words);
    anamorphic_[row.number][word] = number(words, 1, "the coefficient " + word);
}

void CodeVReader::finish_special(PrescriptionSurface& row) {
    const auto found = specials_.find(row.number);
    if (found == specials_.end()) return;
    const Special& special = found->second;
    const double radius = unit_ * (special.radius == 0 ? 1 : special.radius);
    for (const auto& [number, value] : special.terms) {
        if (value == 0) continue;
        if (special.kind == "ODD") {
            row.aspheric[number] += unit_ * value / std::pow(radius, number);
            continue;
        }
        // The terms are ordered x, y, x^2, x y, y^2, x^3, ...: by degree, and within a degree by the power of y.
        int left = number, degree = 0;
        while (left > degree) left -= ++degree;
        row.form.xy.push_back({degree - left, left, unit_ * value / std::pow(radius, degree)});
    }
}

void CodeVReader::finish_anamorphic(PrescriptionSurface& row) {
    row.form.base = BaseForm::biconic;
    std::map<std::string, double>& terms = anamorphic_[row.number];
    for (int n = 2; n <= 5; ++n) {
        const char letter = "ABCD"[n - 2];
        const double r = terms[{letter, 'R'}] * std::pow(unit_, 1 - 2 * n), p = terms[{letter, 'P'}];
        if (r == 0) continue;
        if (p == 0) {
            row.aspheric[2 * n] += r;
            continue;
        }
        // r ((1 - p) x^2 + (1 + p) y^2)^n
        double binomial = 1;
        for (int k = 0; k <= n; ++k) {
            row.form.xy.push_back({2 * (n - k), 2 * k, r * binomial * std::pow(1 - p, n - k) * std::pow(1 + p, k)});
            binomial *= static_cast<double>(n - k) / (k + 1);
        }
    }
}

void CodeVReader::finish_shape(PrescriptionSurface& row) {
    finish_special(row);
    const auto found = toroids_.find(row.number);
    SurfaceForm& form = row.form;
    if (found == toroids_.end()) {
        form.curvature_x = form.conic_x = 0;  // CUX has no effect on surfaces of revolution
        return;
    }
    const std::string& kind = found->second;
    if (kind == "AAS") return finish_anamorphic(row);
    form.base = BaseForm::toroid;
    form.conic_x = 0;
    if (kind == "YTO" || (kind == "CYL" && form.curvature_x == 0)) return;
    std::swap(row.curvature, form.curvature_x);
    turn_about_axis(row);
}

}  // namespace realcam::io
