#pragma once
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "form_kind.hpp"

namespace REALCAM_NAMESPACE {

/// Order and normalisation of the Zernike polynomials.
enum class ZernikeOrder {
    noll,  ///< Noll's order, each term with an RMS of 1 over the circle ("Zernike standard")
    fringe,  ///< the order of the University of Arizona, each term of amplitude 1 at the rim
};

/// Degree n and azimuthal order m of a Zernike term; its azimuthal factor is cos(m theta), or sin(|m| theta) if m < 0.
struct ZernikeIndex {
    int n, m;
};

/// Returns the indices of term `number`, counted from 1.
inline ZernikeIndex zernike_index(ZernikeOrder order, int number) {
    if (order == ZernikeOrder::noll) {
        int n = 0;
        while ((n + 1) * (n + 2) / 2 < number) ++n;
        const int position = number - n * (n + 1) / 2 - 1;  // among the terms of degree n, from 0
        const int m = n % 2 == 0 ? 2 * ((position + 1) / 2) : 2 * (position / 2) + 1;
        return {n, number % 2 == 0 ? m : -m};
    }
    // Terms of equal n + |m| form a group: pairs of cosine and sine with m descending, the term with m = 0 last. Term
    // 37 of the usual fringe list is (12, 0) instead of the next in order, (6, 6).
    if (number == 37) return {12, 0};
    int group = 0;
    while ((group + 1) * (group + 1) < number) ++group;
    const int position = number - group * group - 1, m = group - position / 2;
    return {2 * group - m, position % 2 == 0 ? m : -m};
}

/// Returns a sum of Zernike terms as a sum of terms of x^i y^j, with x and y in units of the circle's radius and
/// coefficients in mm. Sorted by j, then by i, both descending.
template <class T>
std::vector<XyTermOf<T>> zernike_as_xy(ZernikeOrder order, const std::vector<T>& coefficients) {
    const auto factorial = [](int n) {
        double product = 1;
        for (int i = 2; i <= n; ++i) product *= i;
        return product;
    };
    const auto binomial = [&](int n, int k) { return factorial(n) / (factorial(k) * factorial(n - k)); };
    std::map<std::pair<int, int>, T> sums;
    for (std::size_t k = 0; k < coefficients.size(); ++k) {
        if (is_constant_zero(coefficients[k])) continue;
        const auto [n, signed_m] = zernike_index(order, static_cast<int>(k) + 1);
        const int m = std::abs(signed_m);
        const double norm = order == ZernikeOrder::noll ? std::sqrt((m == 0 ? 1.0 : 2.0) * (n + 1)) : 1.0;
        for (int s = 0; s <= (n - m) / 2; ++s) {
            const double radial = (s % 2 == 0 ? 1 : -1) * factorial(n - s) /
                                  (factorial(s) * factorial((n + m) / 2 - s) * factorial((n - m) / 2 - s));
            // r^(n - 2 s - m) = (x^2 + y^2)^squares, times the real or imaginary part of (x + i y)^m.
            const int squares = (n - m) / 2 - s;
            for (int a = 0; a <= squares; ++a)
                for (int j = signed_m < 0 ? 1 : 0; j <= m; j += 2) {
                    const double sign = j / 2 % 2 == 0 ? 1 : -1;
                    sums[{j + 2 * a, m - j + 2 * (squares - a)}] +=
                        coefficients[k] * norm * radial * binomial(squares, a) * sign * binomial(m, j);
                }
        }
    }
    std::vector<XyTermOf<T>> result;
    for (auto term = sums.rbegin(); term != sums.rend(); ++term)
        result.push_back({term->first.second, term->first.first, term->second});
    return result;
}

/// Zernike terms of the sag: a sum of Zernike polynomials over a circle about the vertex. The azimuth counts from the x
/// axis towards y. The methods are those of form_kind.hpp.
struct ZernikeTerms {
    ZernikeOrder order = ZernikeOrder::noll;
    double radius = 1;  ///< radius of the circle, mm
    std::vector<double> coefficients;  ///< coefficients of the terms 1, 2, ..., mm

    static constexpr FormNames words = {.key = "zernike",
                                        .name = "Zernike",
                                        .asymmetry = "has Zernike terms",
                                        .first_number = 1,
                                        .variant_key = "order",
                                        .variants = {"noll", "fringe"}};
    static constexpr auto variant = &ZernikeTerms::order;

    bool operator==(const ZernikeTerms&) const = default;

    int max_coefficients() const {
        return order == ZernikeOrder::fringe ? 37 : (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;
    }
    template <class Surface>
    std::string error(const Surface&) const {
        return "";
    }
    void negate() { form_detail::negate_all(coefficients); }
    std::vector<XyTerm> as_xy() const { return zernike_as_xy(order, coefficients); }
    void add_sag(double& z, double x, double y, const ConicNumbers<double>&) const {
        for (const XyTerm& term : as_xy())
            z += term.coefficient * std::pow(x / radius, term.x) * std::pow(y / radius, term.y);
    }
    double vertex_curvature() const { return 0; }
    template <class T>
    void add_to(FormPolynomials<T>& polynomials, const std::vector<T>& numbers, const ConicNumbers<T>&) const {
        polynomials.xy.add(zernike_as_xy(order, numbers), polynomials.reach / radius);
    }
    const char* beyond_polynomials() const { return ""; }
};

}  // namespace REALCAM_NAMESPACE
