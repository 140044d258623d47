#pragma once
#include <string>
#include <utility>
#include <vector>

#include "../../error.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr double kLineF_nm = 486.1327;  ///< hydrogen, blue
inline constexpr double kLineD_nm = 587.5618;  ///< helium, yellow: the design line d
inline constexpr double kLineC_nm = 656.2725;  ///< hydrogen, red

/// An optical medium: refractive index relative to air at a wavelength in air.
class Glass {
public:
    /// One term of the Sellmeier equation n^2 = 1 + sum B l^2 / (l^2 - C), with the wavelength l in um.
    struct SellmeierTerm {
        double B, C;  ///< 1, um^2
    };
    /// One measured refractive index.
    struct TablePoint {
        double wavelength_nm, index;

        bool operator==(const TablePoint&) const = default;
    };

    /// Medium whose index is the same at all wavelengths.
    static Glass constant(double index) { return {Formula::cauchy, {index}, {}}; }
    static Glass air() { return constant(1.0); }

    /// Two-term Cauchy formula with this index at the d line and Abbe number V_d = (n_d - 1) / (n_F - n_C). Throws
    /// InputError for an index below 1 or an Abbe number that is not positive.
    static Glass from_abbe_number(double n_d, double abbe_number);
    /// Cauchy's formula n = A + B / l^2 + C / l^4 + ..., l in um. Throws InputError if there is no coefficient, or one
    /// is not finite.
    static Glass cauchy(std::vector<double> coefficients);

    /// Sellmeier's equation. Throws InputError if there is no term, or a coefficient is not finite.
    static Glass sellmeier(const std::vector<SellmeierTerm>& terms);
    /// Table of measured indices, with cubic interpolation in 1 / l^2 through the four nearest points (or through all,
    /// if there are fewer). Throws InputError if there is no point, two points have the same wavelength, or a number is
    /// invalid.
    static Glass table(std::vector<TablePoint> points);

    /// Refractive index; NaN if the formula has no real value.
    double index(double wavelength_nm) const;

    /// True if the index is the same at all wavelengths, as far as is known.
    bool has_one_index() const;
    /// Shortest and longest wavelength at which the index is known, nm: the range of a table, and (0, inf) for formulas
    /// and tables of one point.
    std::pair<double, double> known_nm() const;

    bool is_air() const { return formula_ == Formula::cauchy && coefficients_ == std::vector<double>{1.0}; }

    bool operator==(const Glass&) const = default;

    /// The medium as the lens's author specified it: a catalogue name, an index, or n_d and V_d; empty for air.
    std::string label;

    enum class Formula { cauchy, sellmeier, table };

    /// The complete data of a glass, for serialisation.
    struct Parts {
        Formula formula;
        std::vector<double> coefficients;  ///< Cauchy: A, B, C, ...; Sellmeier: B and C alternating
        std::vector<TablePoint> points;
        std::string label;
    };
    Parts parts() const { return {formula_, coefficients_, points_, label}; }
    /// Restores a glass from its parts, which are not checked.
    static Glass from_parts(Parts parts);

private:
    Glass(Formula formula, std::vector<double> coefficients, std::vector<TablePoint> points)
        : formula_(formula), coefficients_(std::move(coefficients)), points_(std::move(points)) {}

    /// Throws InputError if a number is infinite or NaN.
    static void check_all_finite(const std::vector<double>& numbers);

    /// Returns 1 / l^2 in um^-2, the variable of Cauchy's formula.
    static double inverse_square_um(double wavelength_nm) { return 1e6 / (wavelength_nm * wavelength_nm); }

    /// Index by Sellmeier's equation; `square_um`: l^2 in um^2.
    double sellmeier_index(double square_um) const;

    /// Index by interpolation in the table; `x`: 1 / l^2 in um^-2.
    double table_index(double x) const;

    Formula formula_;
    std::vector<double> coefficients_;  ///< see Parts
    std::vector<TablePoint> points_;  ///< by ascending wavelength
};

}  // namespace REALCAM_NAMESPACE
