#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <vector>

#include "../../platform.hpp"
#include "lens_limits.hpp"

// Interface of the kinds of sag terms, whose registry is kFormTerms in surface_form.hpp, and the types that they share.
// A kind is a struct such as ZernikeTerms, which holds the numbers of the terms as a lens file specifies them, and has:
//   words                static FormNames: the names of this kind
//   variant              static pointer to the member that holds the variant; absent if there is only one variant
//   radius               normalisation radius, mm
//   coefficients         std::vector<double>
//   max_coefficients()   maximum number of coefficients
//   error(surface)       reason why the terms are not compatible with the surface's other parameters; empty if they are
//   negate()             negates the sag
//   add_sag(z, x, y, conic)  adds the sag of the terms at (x, y), mm, to z, mm
//   vertex_curvature()   curvature that the terms add at the vertex, 1/mm
//   add_to(polynomials, coefficients, conic)  adds the terms, with these coefficients, to the polynomials that are
//                        traced; a template on the number type, which is a dual number for derivatives with respect to
//                        the coefficients and the conic
//   beyond_polynomials() name, for messages, of terms that are not a polynomial in x and y, which files of other
//                        programs cannot represent; empty if they are such a polynomial

namespace REALCAM_NAMESPACE {

/// Names of one kind of terms.
struct FormNames {
    const char* key;  ///< in lens files, in Python, and as a variable of optimisations: "forbes"
    const char* name;  ///< in messages: "Forbes"
    const char* asymmetry = "";  ///< reason why these terms are not rotationally symmetric; empty if they are
    int first_number = 0;  ///< number by which users count the first coefficient: 0 or 1
    const char* coefficients_key = "coefficients_mm";  ///< key of the coefficients in lens files and in Python
    bool are_lengths = true;  ///< true: the coefficients are lengths in mm; false: they have no unit
    const char* variant_key = "";  ///< key of the variant; empty if there is only one
    std::array<const char*, 2> variants = {};  ///< names of the variants, in the order of their enumeration
};

/// Term of the sag: coefficient * x^i * y^j. T: double, or dual numbers.
template <class T>
struct XyTermOf {
    int x, y;  ///< powers i and j
    T coefficient;  ///< mm^(1 - i - j)

    bool operator==(const XyTermOf&) const = default;
};
using XyTerm = XyTermOf<double>;

/// The conic of revolution to which terms are added.
template <class T>
struct ConicNumbers {
    T curvature, conic;  ///< 1/mm, and the conic constant k
};

/// True if a number is 0; the overload for dual numbers also requires it to be constant.
inline bool is_constant_zero(double number) {
    return number == 0;
}

/// Returns the value of a number; there is an overload for dual numbers.
template <std::floating_point T>
double plain_value(T number) {
    return static_cast<double>(number);
}

/// Coefficients of x^i y^j, i + j <= degree.
template <class T>
struct XyTable {
    int degree = -1;  ///< -1: no terms
    std::vector<T> by_powers = std::vector<T>((kMaxXyDegree + 1) * (kMaxXyDegree + 1), T(0.0));

    /// Coefficient of the term with these powers.
    T& at(int x, int y) { return by_powers[static_cast<std::size_t>(x * (kMaxXyDegree + 1) + y)]; }
    /// Adds terms of x and y after the substitution x -> unit x, y -> unit y.
    void add(const std::vector<XyTermOf<T>>& terms, double unit) {
        for (const XyTermOf<T>& term : terms) {
            at(term.x, term.y) += term.coefficient * std::pow(unit, term.x + term.y);
            degree = std::max(degree, term.x + term.y);
        }
    }
};

/// The polynomials that represent terms in the ray trace (see FreeformView). T: double, or dual numbers.
template <class T>
struct FormPolynomials {
    double reach;  ///< x and y of `xy` are in units of this length, mm
    XyTable<T> xy;
    /// Polynomial in 2 w - 1, w = (r / even_radius)^2: coefficients by ascending power, mm. Its sum is multiplied by w
    /// (1 - w) / sqrt(1 - c^2 r^2) if is_bfs, else by w^2.
    std::vector<T> even;
    double even_radius = 1;  ///< mm
    bool is_bfs = false;
};

namespace form_detail {

/// Returns the sum of coefficients[i] u^i.
inline double polynomial(const std::vector<double>& coefficients, double u) {
    double sum = 0;
    for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * u + coefficients[i];
    return sum;
}

/// True if a value is not 0.
inline bool any_of(const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
}

inline void negate_all(std::vector<double>& values) {
    for (double& value : values) value = -value;
}

}  // namespace form_detail

}  // namespace REALCAM_NAMESPACE
