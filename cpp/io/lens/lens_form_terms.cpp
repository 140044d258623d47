#include "lens_form_terms.hpp"

#include <cmath>

namespace realcam::io {

namespace {

/// Adds the powers of r of u^4 times a polynomial in t = 2 u^2 - 1.
void add_forbes(const ForbesTerms& forbes, std::map<int, double>& terms) {
    const std::vector<double> in_t = forbes.in_powers();
    std::vector<double> in_square(in_t.size(), 0.0);
    for (std::size_t k = in_t.size(); k-- > 0;) {
        for (std::size_t i = in_square.size(); i-- > 0;)
            in_square[i] = (i > 0 ? 2 * in_square[i - 1] : 0) - in_square[i];
        in_square[0] += in_t[k];
    }
    for (std::size_t k = 0; k < in_square.size(); ++k) {
        const int power = 4 + 2 * static_cast<int>(k);
        if (in_square[k] != 0) terms[power] += in_square[k] / std::pow(forbes.radius, power);
    }
}

}  // namespace

std::map<int, double> radial_terms_of(const Surface& surface) {
    std::map<int, double> terms;
    for (std::size_t k = 0; k < surface.aspheric.size(); ++k)
        if (surface.aspheric[k] != 0) terms[2 * static_cast<int>(k) + 4] += surface.aspheric[k];
    const SurfaceForm& form = surface.form;
    for (std::size_t k = 0; k < form.radial.size(); ++k)
        if (form.radial[k] != 0) terms[static_cast<int>(k) + 1] += form.radial[k];
    if (form.forbes && form.forbes->kind == ForbesKind::con) add_forbes(*form.forbes, terms);
    return terms;
}

std::map<XyPower, double> xy_terms_of(const Surface& surface) {
    std::map<XyPower, double> terms;
    const auto add = [&](int x, int y, double value) {
        if (value != 0) terms[{x + y, y}] += value;
    };
    const SurfaceForm& form = surface.form;
    for (const XyTerm& term : form.xy) add(term.x, term.y, term.coefficient);
    if (form.zernike)
        for (const XyTerm& term : form.zernike->as_xy())
            add(term.x, term.y, term.coefficient / std::pow(form.zernike->radius, term.x + term.y));
    for (const auto& [power, value] : radial_terms_of(surface)) {
        if (power % 2 != 0) continue;
        double binomial = 1;
        for (int k = 0; k <= power / 2; ++k) {
            add(power - 2 * k, 2 * k, binomial * value);
            binomial *= static_cast<double>(power / 2 - k) / (k + 1);
        }
    }
    return terms;
}

std::string beyond_polynomials(const SurfaceForm& form) {
    std::string found;
    over_terms(form, [&](const auto& terms) {
        if (found.empty()) found = terms.beyond_polynomials();
    });
    return found;
}

bool has_odd_terms(const Surface& surface) {
    for (const auto& [power, value] : radial_terms_of(surface))
        if (power % 2 != 0) return true;
    return false;
}

}  // namespace realcam::io
