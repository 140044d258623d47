#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "forbes_terms.hpp"
#include "superconic_terms.hpp"
#include "zernike_terms.hpp"

namespace REALCAM_NAMESPACE {

/// Base shape to which the other terms of the sag are added. The radius and conic of Surface belong to the section in
/// the yz plane.
enum class BaseForm {
    conic,  ///< conic of revolution
    biconic,  ///< (c_x x^2 + c_y y^2) / (1 + sqrt(1 - (1 + k_x) c_x^2 x^2 - (1 + k_y) c_y^2 y^2))
    toroid,  ///< the section in the yz plane, including its even terms of y, rotated about a line parallel to y
};

/// Sag of a surface beyond a conic of revolution and its even aspheric terms. All parts are added.
struct SurfaceForm {
    BaseForm base = BaseForm::conic;
    double curvature_x = 0;  ///< biconic: in the xz plane; toroid: 1 / distance from the vertex to the line; 1/mm
    double conic_x = 0;  ///< biconic: in the xz plane
    std::vector<double> radial;  ///< coefficients of r, r^2, r^3, ..., 1, mm^-1, mm^-2, ...
    std::vector<XyTerm> xy;
    std::optional<ZernikeTerms> zernike;
    std::optional<ForbesTerms> forbes;
    std::optional<SuperconicTerms> superconic;

    bool operator==(const SurfaceForm&) const = default;

    bool has_conic_base() const { return base == BaseForm::conic; }
    /// True if the form has terms of any kind, even if all coefficients are 0.
    bool has_terms() const;
    /// True if the surface is a conic of revolution with at most even aspheric terms.
    bool is_none() const;
    /// Returns the form with all lengths multiplied by `factor`.
    SurfaceForm scaled(double factor) const;
    /// Returns the form with its sag negated.
    SurfaceForm turned() const;
    /// Reason why the form is not rotationally symmetric: "is toroidal"; empty if it is.
    std::string asymmetry() const;
};

/// The registry of forms: one row for each kind of terms. A row's type names its terms, checks them and converts them
/// to what is traced (see form_row.hpp). Readers, writers, checks, derivatives and bindings go by this table.
inline constexpr std::tuple kFormTerms{&SurfaceForm::zernike, &SurfaceForm::forbes, &SurfaceForm::superconic};
inline constexpr std::size_t kFormTermsCount = std::tuple_size_v<decltype(kFormTerms)>;

/// Type of the terms that a std::optional of a form holds.
template <class Optional>
using TermsIn = typename std::remove_cvref_t<Optional>::value_type;

/// Calls f(optional) with the std::optional of each row of kFormTerms, whether the form has these terms or not.
template <class Form, class F>
constexpr void over_rows(Form& form, F&& f) {
    std::apply([&](auto... row) { (f(form.*row), ...); }, kFormTerms);
}

/// Calls f(terms) for each kind of terms that the form has.
template <class Form, class F>
constexpr void over_terms(Form& form, F&& f) {
    over_rows(form, [&](auto& terms) {
        if (terms) f(*terms);
    });
}

namespace form_detail {
template <class Terms>
constexpr const FormWords& words_of(std::optional<Terms> SurfaceForm::*) {
    return Terms::words;
}
template <class Variant, class Terms>
constexpr bool has_variant(std::optional<Terms> SurfaceForm::*) {
    if constexpr (requires { Terms::variant; })
        return std::is_same_v<Variant Terms::*, std::remove_const_t<decltype(Terms::variant)>>;
    return false;
}
}  // namespace form_detail

/// True for the enumerations of the variants of terms. They have two enumerators.
template <class E>
inline constexpr bool is_form_variant =
    std::apply([](auto... row) { return (form_detail::has_variant<E>(row) || ...); }, kFormTerms);

/// The names of the rows of kFormTerms.
inline constexpr std::array<FormWords, kFormTermsCount> kFormWords =
    std::apply([](auto... row) { return std::array{form_detail::words_of(row)...}; }, kFormTerms);

}  // namespace REALCAM_NAMESPACE
