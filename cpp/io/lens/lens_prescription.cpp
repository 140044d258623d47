#include "lens_prescription.hpp"

#include "../../optics/prescription/lens_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace realcam::io {
namespace {

constexpr int kLargestPower = 2 * kMaxAsphericTerms + 2;
/// Largest deviation of the surface from the file's, mm: round trips through other programs are required to be within
/// 1e-9 mm.
constexpr double kLargestDifference = 1e-10;

/// Returns the coefficients of the polynomial through `kMaxAsphericTerms` points of a function on [0, 1]. At the
/// Chebyshev nodes, so that it is nearly the best one everywhere.
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

/// Folds a term a2 r^2 into the curvature. The sag c r^2 / (1 + S) + a2 r^2 with S = sqrt(1 - q), q = (1 + k) c^2 r^2,
/// has the vertex curvature c' = c + 2 a2. A conic of that curvature with (1 + k') c'^2 = (1 + k) c^2 has the same S,
/// so that the remainder is a2 r^2 (S - 1) / (S + 1) = -a2 r^2 q / (1 + S)^2, without a term of r^2. It is 0 for a
/// plane and for a paraboloid, where q is 0; otherwise 1 / (1 + S)^2 is replaced by a polynomial in q that is accurate
/// up to the rim. Returns the term that cannot be folded, or an empty string.
std::string fold_square_term(double a2, double height, Surface& surface) {
    const double c = surface.curvature, square = (1 + surface.conic) * c * c;
    const double folded = c + 2 * a2, q_rim = square * height * height;
    if (folded == 0 && square != 0)
        return "a term of r^2 that cancels the curvature of a conic, of which no conic is left";
    surface.curvature = folded;
    if (folded != 0) surface.conic = square / (folded * folded) - 1;
    if (square == 0) return {};
    if (!(q_rim < 1)) return "a term of r^2 on a conic that ends inside the clear semi-diameter";
    const auto exact = [&](double share) {
        const double root = std::sqrt(1 - share * q_rim);
        return 1 / ((1 + root) * (1 + root));
    };
    const std::vector<double> terms = polynomial_through(exact);
    surface.aspheric.resize(static_cast<std::size_t>(kMaxAsphericTerms), 0.0);
    for (std::size_t j = 0; j < terms.size(); ++j)
        surface.aspheric[j] -= a2 * square * terms[j] * std::pow(height, -2.0 * static_cast<double>(j));
    double difference = 0;
    constexpr int kSamples = 64;
    for (int i = 0; i <= kSamples; ++i) {
        const double share = static_cast<double>(i) / kSamples;  // fraction of the squared height
        double kept = 0;
        for (std::size_t j = terms.size(); j-- > 0;) kept = kept * share + terms[j];
        difference =
            std::max(difference, std::fabs(a2 * q_rim * height * height * share * share * (kept - exact(share))));
    }
    if (difference <= kLargestDifference) return {};
    return "a term of r^2 on a conic so steep that no terms up to r^" + std::to_string(kLargestPower) + " replace it";
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
    std::string foreign;
    for (const auto& [power, value] : row.aspheric) {
        if (value == 0) continue;
        if (power == 2) {
            square = value;
        } else if (power % 2 != 0 || power > kLargestPower) {
            if (!is_toroid && power > 0 && power <= kMaxRadialTerms)
                add_radial(power, value);
            else
                foreign += (foreign.empty() ? "an aspheric term of r^" : " and of r^") + std::to_string(power);
        } else {
            const auto term = static_cast<std::size_t>(power / 2 - 2);
            if (surface.aspheric.size() <= term) surface.aspheric.resize(term + 1, 0.0);
            surface.aspheric[term] = value;
        }
    }
    if (square == 0) return foreign;
    if (!is_toroid && !surface.form.is_none()) {
        add_radial(2, square);
        return foreign;
    }
    const Surface before = surface;
    std::string folded = fold_square_term(square, height, surface);
    if (!folded.empty() && !is_toroid) {
        surface = before;
        add_radial(2, square);
        folded.clear();
    }
    return foreign.empty() || folded.empty() ? foreign + folded : foreign + " and " + folded;
}

}  // namespace realcam::io
