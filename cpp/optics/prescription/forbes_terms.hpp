#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "form_kind.hpp"

namespace REALCAM_NAMESPACE {

/// The two kinds of Forbes polynomials, with u = r / radius and the curvature c of the base.
enum class ForbesKind {
    bfs,  ///< Q^bfs: departure from a sphere, u^2 (1 - u^2) / sqrt(1 - c^2 r^2) times a sum of a_m Q_m(u^2)
    con,  ///< Q^con: departure from a conic, u^4 times a sum of a_m Q_m(u^2)
};

namespace forbes_detail {

/// Coefficients of a polynomial in one variable, the constant first.
using Polynomial = std::vector<double>;

/// Returns factor_a a + factor_b b.
inline Polynomial weighted_sum(const Polynomial& a, const Polynomial& b, double factor_a, double factor_b) {
    Polynomial result(std::max(a.size(), b.size()), 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) result[i] += factor_a * a[i];
    for (std::size_t i = 0; i < b.size(); ++i) result[i] += factor_b * b[i];
    return result;
}

/// Returns p(t) (a + b t).
inline Polynomial times_linear(const Polynomial& p, double a, double b) {
    Polynomial result(p.size() + 1, 0.0);
    for (std::size_t i = 0; i < p.size(); ++i) {
        result[i] += a * p[i];
        result[i + 1] += b * p[i];
    }
    return result;
}

/// Returns Q_m^bfs for m = 0 to count - 1 by Forbes's recurrence (Forbes 2007), as polynomials in t = 2 w - 1, w = u^2.
/// f, g, h and the auxiliary polynomials P_m are named as there; its factor 2 - 4 w is -2 t.
inline std::vector<Polynomial> bfs_polynomials(int count) {
    std::vector<Polynomial> p = {{2.0}, {2.0, -4.0}}, q;
    std::vector<double> f, g, h;
    for (int m = 0; m < count; ++m) {
        if (m >= 2)
            p.push_back(weighted_sum(times_linear(p[static_cast<std::size_t>(m) - 1], 0, -2),
                                     p[static_cast<std::size_t>(m) - 2], 1, -1));
        // Element m - back of a list.
        const auto at = [m](const std::vector<double>& list, int back) {
            return list[static_cast<std::size_t>(m - back)];
        };
        if (m == 0) {
            f.push_back(2);
        } else if (m == 1) {
            g.push_back(-0.5);
            f.push_back(std::sqrt(19.0) / 2);
        } else {
            h.push_back(-m * (m - 1) / (2 * at(f, 2)));
            g.push_back(-(1 + at(g, 2) * at(h, 2)) / at(f, 1));
            f.push_back(std::sqrt(m * (m + 1) + 3 - at(g, 1) * at(g, 1) - at(h, 2) * at(h, 2)));
        }
        Polynomial next = p[static_cast<std::size_t>(m)];
        if (m >= 1) next = weighted_sum(next, q[static_cast<std::size_t>(m) - 1], 1, -at(g, 1));
        if (m >= 2) next = weighted_sum(next, q[static_cast<std::size_t>(m) - 2], 1, -at(h, 2));
        for (double& c : next) c /= f.back();
        q.push_back(next);
    }
    return q;
}

/// Returns Q_m^con for m = 0 to count - 1 as polynomials in t: the Jacobi polynomials P_m^(0,4)(t), by their three-term
/// recurrence.
inline std::vector<Polynomial> con_polynomials(int count) {
    std::vector<Polynomial> q = {{1.0}, {-2.0, 3.0}};
    for (int m = 2; m < count; ++m) {
        const double c = 2.0 * m + 4;
        const double divisor = 2 * m * (m + 4) * (c - 2);
        q.push_back(weighted_sum(
            times_linear(q[static_cast<std::size_t>(m) - 1], (c - 1) * -16 / divisor, (c - 1) * c * (c - 2) / divisor),
            q[static_cast<std::size_t>(m) - 2], 1, -2 * (m - 1) * (m + 3) * c / divisor));
    }
    return q;
}

}  // namespace forbes_detail

/// Returns the sum of coefficients[m] Q_m(w), w = (r / radius)^2, as a polynomial in 2 w - 1: its coefficients by
/// ascending power.
template <class T>
std::vector<T> forbes_polynomial(ForbesKind kind, const std::vector<T>& coefficients) {
    const int count = static_cast<int>(coefficients.size());
    const auto q =
        kind == ForbesKind::bfs ? forbes_detail::bfs_polynomials(count) : forbes_detail::con_polynomials(count);
    std::vector<T> total(coefficients.size(), T(0.0));
    for (std::size_t m = 0; m < coefficients.size(); ++m)
        for (std::size_t i = 0; i < q[m].size(); ++i) total[i] += coefficients[m] * q[m][i];
    return total;
}

/// Forbes terms of the sag: G. W. Forbes, "Shape specification for axially symmetric optical surfaces", Opt. Express
/// 15, 5218 (2007). The methods are those of form_kind.hpp.
struct ForbesTerms {
    ForbesKind kind = ForbesKind::bfs;
    double radius = 1;  ///< normalisation radius, mm
    std::vector<double> coefficients;  ///< a_0, a_1, ..., mm

    static constexpr FormNames words = {
        .key = "forbes", .name = "Forbes", .variant_key = "kind", .variants = {"bfs", "con"}};
    static constexpr auto variant = &ForbesTerms::kind;

    bool operator==(const ForbesTerms&) const = default;

    int max_coefficients() const { return kMaxForbesTerms; }
    template <class Surface>
    std::string error(const Surface& surface) const {
        if (kind == ForbesKind::con || (surface.conic == 0 && surface.form.has_conic_base())) return "";
        return "Forbes terms of the kind \"bfs\" depart from a sphere, so the conic must be 0";
    }
    void negate() { form_detail::negate_all(coefficients); }
    /// Sum of a_m Q_m as a polynomial in 2 w - 1, w = (r / radius)^2.
    std::vector<double> in_powers() const { return forbes_polynomial(kind, coefficients); }
    void add_sag(double& z, double x, double y, const ConicNumbers<double>& conic) const {
        const double r2 = x * x + y * y, w = r2 / (radius * radius),
                     sum = form_detail::polynomial(in_powers(), 2 * w - 1);
        const double root = std::sqrt(1 - conic.curvature * conic.curvature * r2);
        z += kind == ForbesKind::con ? w * w * sum : w * (1 - w) / root * sum;
    }
    double vertex_curvature() const {
        return kind == ForbesKind::con ? 0 : 2 * form_detail::polynomial(in_powers(), -1) / (radius * radius);
    }
    template <class T>
    void add_to(FormPolynomials<T>& polynomials, const std::vector<T>& numbers, const ConicNumbers<T>&) const {
        polynomials.even = forbes_polynomial(kind, numbers);
        polynomials.even_radius = radius;
        polynomials.is_bfs = kind == ForbesKind::bfs;
    }
    const char* beyond_polynomials() const {
        return kind == ForbesKind::bfs ? "Forbes terms of a departure from a sphere" : "";
    }
};

}  // namespace REALCAM_NAMESPACE
