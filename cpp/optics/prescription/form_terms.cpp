#include "form_terms.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace realcam {

namespace {

/// Coefficients of a polynomial in one variable, the constant first.
using Polynomial = std::vector<double>;

Polynomial sum(const Polynomial& a, const Polynomial& b, double times_a, double times_b) {
    Polynomial result(std::max(a.size(), b.size()), 0.0);
    for (std::size_t i = 0; i < a.size(); ++i) result[i] += times_a * a[i];
    for (std::size_t i = 0; i < b.size(); ++i) result[i] += times_b * b[i];
    return result;
}

/// Returns p(t) (a + b t).
Polynomial times_linear(const Polynomial& p, double a, double b) {
    Polynomial result(p.size() + 1, 0.0);
    for (std::size_t i = 0; i < p.size(); ++i) {
        result[i] += a * p[i];
        result[i + 1] += b * p[i];
    }
    return result;
}

double factorial(int n) {
    double product = 1;
    for (int i = 2; i <= n; ++i) product *= i;
    return product;
}

double binomial(int n, int k) {
    return factorial(n) / (factorial(k) * factorial(n - k));
}

/// Q_m^bfs by Forbes's recurrence, as polynomials in t = 2 w - 1; his factor 2 - 4 w is -2 t.
std::vector<Polynomial> bfs_polynomials(int count) {
    std::vector<Polynomial> p = {{2.0}, {2.0, -4.0}}, q;
    std::vector<double> f, g, h;
    for (int m = 0; m < count; ++m) {
        if (m >= 2)
            p.push_back(sum(times_linear(p[static_cast<std::size_t>(m) - 1], 0, -2), p[static_cast<std::size_t>(m) - 2],
                            1, -1));
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
        if (m >= 1) next = sum(next, q[static_cast<std::size_t>(m) - 1], 1, -at(g, 1));
        if (m >= 2) next = sum(next, q[static_cast<std::size_t>(m) - 2], 1, -at(h, 2));
        for (double& c : next) c /= f.back();
        q.push_back(next);
    }
    return q;
}

/// Q_m^con is the Jacobi polynomial P_m^(0,4)(t).
std::vector<Polynomial> con_polynomials(int count) {
    std::vector<Polynomial> q = {{1.0}, {-2.0, 3.0}};
    for (int m = 2; m < count; ++m) {
        const double c = 2.0 * m + 4;
        const double divisor = 2 * m * (m + 4) * (c - 2);
        q.push_back(sum(
            times_linear(q[static_cast<std::size_t>(m) - 1], (c - 1) * -16 / divisor, (c - 1) * c * (c - 2) / divisor),
            q[static_cast<std::size_t>(m) - 2], 1, -2 * (m - 1) * (m + 3) * c / divisor));
    }
    return q;
}

}  // namespace

ZernikeIndex zernike_index(ZernikeOrder order, int number) {
    if (order == ZernikeOrder::noll) {
        int n = 0;
        while ((n + 1) * (n + 2) / 2 < number) ++n;
        const int place = number - n * (n + 1) / 2 - 1;  // position among the terms of degree n, from 0
        const int m = n % 2 == 0 ? 2 * ((place + 1) / 2) : 2 * (place / 2) + 1;
        return {n, number % 2 == 0 ? m : -m};
    }
    // Terms of equal n + |m| form a group: pairs of cosine and sine with m descending, the term with m = 0 last. Term
    // 37 of the usual fringe list is (12, 0) instead of the next in order, (6, 6).
    if (number == 37) return {12, 0};
    int group = 0;
    while ((group + 1) * (group + 1) < number) ++group;
    const int place = number - group * group - 1, m = group - place / 2;
    return {2 * group - m, place % 2 == 0 ? m : -m};
}

std::vector<XyTerm> zernike_as_xy(const ZernikeTerms& terms) {
    std::map<std::pair<int, int>, double> sums;
    for (std::size_t k = 0; k < terms.coefficients.size(); ++k) {
        if (terms.coefficients[k] == 0) continue;
        const auto [n, signed_m] = zernike_index(terms.order, static_cast<int>(k) + 1);
        const int m = std::abs(signed_m);
        const double norm = terms.order == ZernikeOrder::noll ? std::sqrt((m == 0 ? 1.0 : 2.0) * (n + 1)) : 1.0;
        for (int s = 0; s <= (n - m) / 2; ++s) {
            const double radial = (s % 2 == 0 ? 1 : -1) * factorial(n - s) /
                                  (factorial(s) * factorial((n + m) / 2 - s) * factorial((n - m) / 2 - s));
            // r^(n - 2 s - m) = (x^2 + y^2)^squares, times the real or imaginary part of (x + i y)^m.
            const int squares = (n - m) / 2 - s;
            for (int a = 0; a <= squares; ++a)
                for (int j = signed_m < 0 ? 1 : 0; j <= m; j += 2) {
                    const double sign = j / 2 % 2 == 0 ? 1 : -1;
                    sums[{j + 2 * a, m - j + 2 * (squares - a)}] +=
                        terms.coefficients[k] * norm * radial * binomial(squares, a) * sign * binomial(m, j);
                }
        }
    }
    std::vector<XyTerm> result;
    for (auto term = sums.rbegin(); term != sums.rend(); ++term)
        result.push_back({term->first.second, term->first.first, term->second});
    return result;
}

std::vector<double> forbes_polynomial(const ForbesTerms& terms) {
    const int count = static_cast<int>(terms.coefficients.size());
    const std::vector<Polynomial> q = terms.kind == ForbesKind::bfs ? bfs_polynomials(count) : con_polynomials(count);
    Polynomial total;
    for (std::size_t m = 0; m < terms.coefficients.size(); ++m) total = sum(total, q[m], 1, terms.coefficients[m]);
    return total;
}

}  // namespace realcam
