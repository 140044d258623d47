#include "lens_prescription.hpp"

#include "../../optics/prescription/lens_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace realcam::io {
namespace {

constexpr int kMaxPower = 2 * kMaxAsphericTerms + 2;
/// Greatest error of the converted sag, mm: round trips through other programs are required to be within
/// 1e-9 mm.
constexpr double kMaxSagError_mm = 1e-10;

/// Returns the coefficients, by rising power, of the polynomial that interpolates `f` at kMaxAsphericTerms Chebyshev
/// nodes of [0, 1] (Newton's divided differences).
template <class Function>
std::vector<double> polynomial_through(const Function& f) {
    constexpr int n = kMaxAsphericTerms;
    std::array<double, n> x, difference;
    for (int i = 0; i < n; ++i) {
        x[i] = 0.5 + 0.5 * std::cos(std::numbers::pi * (2 * i + 1) / (2 * n));
        difference[i] = f(x[i]);
    }
    for (int order = 1; order < n; ++order)
        for (int i = n - 1; i >= order; --i)
            difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - order]);
    std::vector<double> c(n, 0.0);
    for (int i = n - 1; i >= 0; --i) {  // c = c (x - x_i) + difference_i
        for (int k = n - 1; k > 0; --k) c[k] = c[k - 1] - x[i] * c[k];
        c[0] = difference[i] - x[i] * c[0];
    }
    return c;
}

/// Converts a term a2 r^2 to curvature, conic and higher terms of `surface`. The sag c r^2 / (1 + S) + a2 r^2 with S =
/// sqrt(1 - q), q = (1 + k) c^2 r^2, has the vertex curvature c' = c + 2 a2. A conic of that curvature with (1 + k')
/// c'^2 = (1 + k) c^2 has the same S, so that the remaining sag is a2 r^2 (S - 1) / (S + 1) = -a2 r^2 q / (1 + S)^2,
/// without a term of r^2. It is 0 for a plane and for a paraboloid, where q is 0; otherwise 1 / (1 + S)^2 is replaced
/// by a polynomial in q that is accurate up to the rim. Returns a noun phrase for a term that cannot be converted, or
/// an empty string.
std::string convert_square_term(double a2, double height, Surface& surface) {
    const double c = surface.curvature, square = (1 + surface.conic) * c * c;
    const double new_curvature = c + 2 * a2, q_rim = square * height * height;
    if (new_curvature == 0 && square != 0)
        return "a term of r^2 that cancels the curvature of a conic, of which no conic is left";
    surface.curvature = new_curvature;
    if (new_curvature != 0) surface.conic = square / (new_curvature * new_curvature) - 1;
    if (square == 0) return {};
    if (!(q_rim < 1)) return "a term of r^2 on a conic that ends inside the clear semi-diameter";
    // 1 / (1 + S)^2 at a fraction of the squared height.
    const auto exact = [&](double fraction) {
        const double root = std::sqrt(1 - fraction * q_rim);
        return 1 / ((1 + root) * (1 + root));
    };
    const std::vector<double> terms = polynomial_through(exact);
    surface.aspheric.resize(static_cast<std::size_t>(kMaxAsphericTerms), 0.0);
    for (std::size_t j = 0; j < terms.size(); ++j)
        surface.aspheric[j] -= a2 * square * terms[j] * std::pow(height, -2.0 * static_cast<double>(j));
    double max_error_mm = 0;
    constexpr int kSamples = 64;
    for (int i = 0; i <= kSamples; ++i) {
        const double fraction = static_cast<double>(i) / kSamples;  // fraction of the squared height
        double value = 0;
        for (std::size_t j = terms.size(); j-- > 0;) value = value * fraction + terms[j];
        max_error_mm = std::max(
            max_error_mm, std::fabs(a2 * q_rim * height * height * fraction * fraction * (value - exact(fraction))));
    }
    if (max_error_mm <= kMaxSagError_mm) return {};
    return "a term of r^2 on a conic so steep that no terms up to r^" + std::to_string(kMaxPower) + " replace it";
}

}  // namespace

std::string set_aspheric_terms(const PrescriptionSurface& row, double height, Surface& surface) {
    surface.curvature = row.curvature;
    surface.conic = row.conic;
    surface.aspheric.clear();
    surface.form = row.form;
    const bool is_toroid = row.form.base == BaseForm::toroid;
    const auto add_radial = [&](int power, double value) {
        std::vector<double>& radial = surface.form.radial;
        radial.resize(std::max(radial.size(), static_cast<std::size_t>(power)), 0.0);
        radial[static_cast<std::size_t>(power) - 1] = value;
    };
    double square = 0;
    std::string unsupported;
    for (const auto& [power, value] : row.aspheric) {
        if (value == 0) continue;
        if (power == 2) {
            square = value;
        } else if (power % 2 != 0 || power > kMaxPower) {
            if (!is_toroid && power > 0 && power <= kMaxRadialTerms)
                add_radial(power, value);
            else
                unsupported += (unsupported.empty() ? "an aspheric term of r^" : " and of r^") + std::to_string(power);
        } else {
            const auto term = static_cast<std::size_t>(power / 2 - 2);
            if (surface.aspheric.size() <= term) surface.aspheric.resize(term + 1, 0.0);
            surface.aspheric[term] = value;
        }
    }
    if (square == 0) return unsupported;
    if (!is_toroid && !surface.form.adds_nothing()) {
        add_radial(2, square);
        return unsupported;
    }
    const Surface before = surface;
    std::string error = convert_square_term(square, height, surface);
    if (!error.empty() && !is_toroid) {
        surface = before;
        add_radial(2, square);
        error.clear();
    }
    return unsupported.empty() || error.empty() ? unsupported + error : unsupported + " and " + error;
}

}  // namespace realcam::io
