#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr double kLineF_nm = 486.1327;  ///< hydrogen, blue
inline constexpr double kLineD_nm = 587.5618;  ///< helium, yellow: the design line d
inline constexpr double kLineC_nm = 656.2725;  ///< hydrogen, red

/// An optical medium: refractive index relative to air at a wavelength in air.
class Glass {
public:
    /// n_k of the Sellmeier equation n^2 = 1 + sum B l^2 / (l^2 - C), l in um, C in um^2.
    struct SellmeierTerm {
        double B, C;
    };
    /// One measured point.
    struct TablePoint {
        double wavelength_nm, index;

        bool operator==(const TablePoint&) const = default;
    };

    static Glass constant(double index) { return {Formula::cauchy, {index}, {}}; }
    static Glass air() { return constant(1.0); }

    /// From the index at the d line and the Abbe number V_d = (n_d - 1) / (n_F - n_C): the two terms of Cauchy's
    /// formula that have both. Throws InputError for an index below 1 or an Abbe number that is not positive.
    static Glass from_abbe_number(double n_d, double abbe_number) {
        check_all_finite({n_d, abbe_number});
        if (!(n_d >= 1)) throw InputError("a glass needs an index n_d of at least 1");
        if (!(abbe_number > 0)) throw InputError("a glass needs a positive Abbe number V_d");
        const double spread = per_um2(kLineF_nm) - per_um2(kLineC_nm);
        const double b = (n_d - 1) / (abbe_number * spread);
        return {Formula::cauchy, {n_d - b * per_um2(kLineD_nm), b}, {}};
    }
    /// n = A + B / l^2 + C / l^4 + ..., l in um. Throws InputError where there is no coefficient, or one not finite.
    static Glass cauchy(std::vector<double> coefficients) {
        if (coefficients.empty()) throw InputError("Cauchy's formula needs at least one coefficient, the index");
        check_all_finite(coefficients);
        return {Formula::cauchy, std::move(coefficients), {}};
    }

    /// Throws InputError where there is no term, or one not finite.
    static Glass sellmeier(const std::vector<SellmeierTerm>& terms) {
        if (terms.empty()) throw InputError("Sellmeier's equation needs at least one term");
        Glass glass{Formula::sellmeier, {}, {}};
        for (const SellmeierTerm& term : terms) {
            check_all_finite({term.B, term.C});
            glass.coefficients_.push_back(term.B);
            glass.coefficients_.push_back(term.C);
        }
        return glass;
    }
    /// Interpolated in 1 / l^2 by the cubic through the four nearest points (fewer where fewer are given).
    /// Throws InputError where there is no point, two have one wavelength, or a number makes no sense.
    static Glass table(std::vector<TablePoint> points) {
        if (points.empty()) throw InputError("a glass table needs at least one (wavelength_nm, index)");
        for (const TablePoint& point : points) {
            check_all_finite({point.wavelength_nm, point.index});
            if (!(point.wavelength_nm > 0)) throw InputError("wavelengths are positive numbers, in nm");
        }
        std::sort(points.begin(), points.end(),
                  [](const TablePoint& a, const TablePoint& b) { return a.wavelength_nm < b.wavelength_nm; });
        const auto twice = std::adjacent_find(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return a.wavelength_nm == b.wavelength_nm;
        });
        if (twice != points.end()) throw InputError("a glass table gives a wavelength twice");
        return {Formula::table, {}, std::move(points)};
    }

    /// NaN where the formula has no real value.
    double index(double wavelength_nm) const {
        switch (formula_) {
            case Formula::sellmeier: return sellmeier_index(1 / per_um2(wavelength_nm));
            case Formula::table: return table_index(per_um2(wavelength_nm));
            case Formula::cauchy: break;
        }
        double n = 0;
        for (std::size_t i = coefficients_.size(); i-- > 0;) n = n * per_um2(wavelength_nm) + coefficients_[i];
        return n;
    }

    /// Whether it is the same at all wavelengths, as far as is known.
    bool has_one_index() const {
        if (formula_ == Formula::table) return points_.size() == 1;
        return formula_ == Formula::cauchy &&
               std::all_of(coefficients_.begin() + 1, coefficients_.end(), [](double b) { return b == 0; });
    }
    /// The first and the last wavelength at which it is known, nm: of a table, those of its points; formulas have none.
    std::pair<double, double> known_nm() const {
        if (formula_ != Formula::table || points_.size() == 1) return {0, std::numeric_limits<double>::infinity()};
        return {points_.front().wavelength_nm, points_.back().wavelength_nm};
    }

    bool is_air() const { return formula_ == Formula::cauchy && coefficients_ == std::vector<double>{1.0}; }

    bool operator==(const Glass&) const = default;

    /// As the lens's author wrote it: a name, a number, a pair; empty for air.
    std::string label;

    enum class Formula { cauchy, sellmeier, table };

    /// All that a glass consists of, for whoever stores it.
    struct Parts {
        Formula formula;
        std::vector<double> coefficients;  ///< of Cauchy's formula; B and C by turns of Sellmeier's
        std::vector<TablePoint> points;
        std::string label;
    };
    Parts parts() const { return {formula_, coefficients_, points_, label}; }
    static Glass from_parts(Parts parts) {
        Glass glass{parts.formula, std::move(parts.coefficients), std::move(parts.points)};
        glass.label = std::move(parts.label);
        return glass;
    }

private:
    Glass(Formula formula, std::vector<double> coefficients, std::vector<TablePoint> points)
        : formula_(formula), coefficients_(std::move(coefficients)), points_(std::move(points)) {}

    static void check_all_finite(const std::vector<double>& numbers) {
        for (const double number : numbers)
            if (!std::isfinite(number)) throw InputError("a glass needs finite numbers");
    }

    static double per_um2(double wavelength_nm) { return 1e6 / (wavelength_nm * wavelength_nm); }

    double sellmeier_index(double um2) const {
        double square = 1;
        for (std::size_t i = 0; i + 1 < coefficients_.size(); i += 2)
            square += coefficients_[i] * um2 / (um2 - coefficients_[i + 1]);
        return std::sqrt(square);
    }

    double table_index(double x) const {
        const std::size_t used = std::min<std::size_t>(4, points_.size());
        // The points are sorted by wavelength, so x falls along them.
        const auto next = std::lower_bound(points_.begin(), points_.end(), x, [](const TablePoint& p, double value) {
            return per_um2(p.wavelength_nm) > value;
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
                const double other = per_um2(points_[static_cast<std::size_t>(first) + j].wavelength_nm);
                weight *= (x - other) / (per_um2(p.wavelength_nm) - other);
            }
            n += weight * p.index;
        }
        return n;
    }

    Formula formula_;
    std::vector<double> coefficients_;
    std::vector<TablePoint> points_;
};

}  // namespace REALCAM_NAMESPACE
