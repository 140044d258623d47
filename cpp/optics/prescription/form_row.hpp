#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <vector>

#include "../../platform.hpp"
#include "lens_limits.hpp"

// Types that the rows of the registry of forms (kFormTerms in surface_form.hpp) are made of. A row is an aggregate of
// the terms' numbers, as a lens file states them, with:
//   words, variant      names; pointer to the member that holds the variant, absent if there is one variant alone
//   radius, coefficients
//   most()              maximum number of coefficients
//   error(surface)      reason why the terms do not fit the surface's other parts; empty if they fit
//   negate()            negates the sag
//   add_sag(z, x, y, conic)  adds the terms to a sag in mm
//   vertex_curvature()  curvature that the terms add at the vertex, 1/mm
//   add_to(polynomials, coefficients, conic)  conversion to what is traced. A template on the number type, which is a
//                       dual number for derivatives with respect to the coefficients and the conic
//   beyond_polynomials()  name of terms that are not a polynomial in x and y and no other program's file can state;
//                       empty if they are one

namespace REALCAM_NAMESPACE {

/// Names of one kind of terms.
struct FormWords {
    const char* key;  ///< in lens files, in Python, and as a variable: "forbes"
    const char* name;  ///< in messages: "Forbes"
    const char* asymmetry = "";  ///< why a surface with these terms lacks rotational symmetry; empty if it has it
    int first_number = 0;  ///< number of the first coefficient
    const char* coefficients_key = "coefficients_mm";
    bool are_lengths = true;  ///< the coefficients have the unit mm, otherwise none
    const char* variant_key = "";
    std::array<const char*, 2> variants = {};
};

/// Term of the sag: coefficient x^i y^j, in mm^(1 - i - j).
template <class T>
struct XyTermOf {
    int x, y;
    T coefficient;

    bool operator==(const XyTermOf&) const = default;
};
using XyTerm = XyTermOf<double>;

/// The conic of revolution to which terms are added.
template <class T>
struct ConicNumbers {
    T curvature, conic;
};

/// True if a number is 0 and, for dual numbers, constant.
inline bool is_constant_zero(double number) {
    return number == 0;
}

/// The value of a number that may be a dual number.
template <std::floating_point T>
double plain_value(T number) {
    return static_cast<double>(number);
}

/// Coefficients of x^i y^j, i + j <= degree.
template <class T>
struct XyTable {
    int degree = -1;
    std::vector<T> by_powers = std::vector<T>((kMaxXyDegree + 1) * (kMaxXyDegree + 1), T(0.0));

    T& at(int x, int y) { return by_powers[static_cast<std::size_t>(x * (kMaxXyDegree + 1) + y)]; }
    /// Adds terms whose x and y are in units of 1 / `unit`.
    void add(const std::vector<XyTermOf<T>>& terms, double unit) {
        for (const XyTermOf<T>& term : terms) {
            at(term.x, term.y) += term.coefficient * std::pow(unit, term.x + term.y);
            degree = std::max(degree, term.x + term.y);
        }
    }
};

/// The polynomials that terms are traced as, see FreeformView. T: double, or dual numbers.
template <class T>
struct FormPolynomials {
    double reach;  ///< x and y of `xy` are in units of this length, mm
    XyTable<T> xy;
    /// Polynomial in 2 w - 1, w = (r / even_radius)^2: coefficients by ascending power, mm. Multiplied by w, and by
    /// (1 - w) / sqrt(1 - c^2 r^2) if is_bfs, by w if not.
    std::vector<T> even;
    double even_radius = 1;
    bool is_bfs = false;
};

namespace form_detail {

/// Returns the sum of coefficients[i] u^i.
inline double polynomial(const std::vector<double>& coefficients, double u) {
    double sum = 0;
    for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * u + coefficients[i];
    return sum;
}

inline bool any_of(const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
}

inline void negate_all(std::vector<double>& values) {
    for (double& value : values) value = -value;
}

}  // namespace form_detail

}  // namespace REALCAM_NAMESPACE
