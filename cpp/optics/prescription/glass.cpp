#include "glass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace realcam {

Glass Glass::from_abbe_number(double n_d, double abbe_number) {
    check_all_finite({n_d, abbe_number});
    if (!(n_d >= 1)) throw InputError("a glass needs an index n_d of at least 1");
    if (!(abbe_number > 0)) throw InputError("a glass needs a positive Abbe number V_d");
    const double spread = inverse_square_um(kLineF_nm) - inverse_square_um(kLineC_nm);
    const double b = (n_d - 1) / (abbe_number * spread);
    return {Formula::cauchy, {n_d - b * inverse_square_um(kLineD_nm), b}, {}};
}

Glass Glass::cauchy(std::vector<double> coefficients) {
    if (coefficients.empty()) throw InputError("Cauchy's formula needs at least one coefficient, the index");
    check_all_finite(coefficients);
    return {Formula::cauchy, std::move(coefficients), {}};
}

Glass Glass::sellmeier(const std::vector<SellmeierTerm>& terms) {
    if (terms.empty()) throw InputError("Sellmeier's equation needs at least one term");
    Glass glass{Formula::sellmeier, {}, {}};
    for (const SellmeierTerm& term : terms) {
        check_all_finite({term.B, term.C});
        glass.coefficients_.push_back(term.B);
        glass.coefficients_.push_back(term.C);
    }
    return glass;
}

Glass Glass::table(std::vector<TablePoint> points) {
    if (points.empty()) throw InputError("a glass table needs at least one (wavelength_nm, index)");
    for (const TablePoint& point : points) {
        check_all_finite({point.wavelength_nm, point.index});
        if (!(point.wavelength_nm > 0))
            throw InputError("the wavelengths of a glass table must be positive numbers, in nm");
    }
    std::sort(points.begin(), points.end(),
              [](const TablePoint& a, const TablePoint& b) { return a.wavelength_nm < b.wavelength_nm; });
    const auto repeated = std::adjacent_find(
        points.begin(), points.end(), [](const auto& a, const auto& b) { return a.wavelength_nm == b.wavelength_nm; });
    if (repeated != points.end()) throw InputError("a glass table contains a wavelength twice");
    return {Formula::table, {}, std::move(points)};
}

double Glass::index(double wavelength_nm) const {
    switch (formula_) {
        case Formula::sellmeier: return sellmeier_index(1 / inverse_square_um(wavelength_nm));
        case Formula::table: return table_index(inverse_square_um(wavelength_nm));
        case Formula::cauchy: break;
    }
    double n = 0;
    for (std::size_t i = coefficients_.size(); i-- > 0;) n = n * inverse_square_um(wavelength_nm) + coefficients_[i];
    return n;
}

bool Glass::has_one_index() const {
    if (formula_ == Formula::table) return points_.size() == 1;
    return formula_ == Formula::cauchy &&
           std::all_of(coefficients_.begin() + 1, coefficients_.end(), [](double b) { return b == 0; });
}

std::pair<double, double> Glass::known_nm() const {
    if (formula_ != Formula::table || points_.size() == 1) return {0, std::numeric_limits<double>::infinity()};
    return {points_.front().wavelength_nm, points_.back().wavelength_nm};
}

Glass Glass::from_parts(Parts parts) {
    Glass glass{parts.formula, std::move(parts.coefficients), std::move(parts.points)};
    glass.label = std::move(parts.label);
    return glass;
}

void Glass::check_all_finite(const std::vector<double>& numbers) {
    for (const double number : numbers)
        if (!std::isfinite(number)) throw InputError("a glass needs finite numbers");
}

double Glass::sellmeier_index(double square_um) const {
    double square = 1;
    for (std::size_t i = 0; i + 1 < coefficients_.size(); i += 2)
        square += coefficients_[i] * square_um / (square_um - coefficients_[i + 1]);
    return std::sqrt(square);
}

double Glass::table_index(double x) const {
    const std::size_t used = std::min<std::size_t>(4, points_.size());
    // Lagrange interpolation. The points are sorted by wavelength, so x falls along them.
    const auto next = std::lower_bound(points_.begin(), points_.end(), x, [](const TablePoint& p, double value) {
        return inverse_square_um(p.wavelength_nm) > value;
    });
    const std::ptrdiff_t half = static_cast<std::ptrdiff_t>(used / 2);
    const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(points_.size() - used);
    const std::ptrdiff_t first = std::clamp<std::ptrdiff_t>(next - points_.begin() - half, 0, last);
    double n = 0;
    for (std::size_t i = 0; i < used; ++i) {
        const TablePoint& p = points_[static_cast<std::size_t>(first) + i];
        double weight = 1;
        for (std::size_t j = 0; j < used; ++j) {
            if (j == i) continue;
            const double other = inverse_square_um(points_[static_cast<std::size_t>(first) + j].wavelength_nm);
            weight *= (x - other) / (inverse_square_um(p.wavelength_nm) - other);
        }
        n += weight * p.index;
    }
    return n;
}

}  // namespace realcam
