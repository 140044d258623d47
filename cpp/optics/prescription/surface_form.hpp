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

/// Base shape to which the other terms of the sag are added. Surface::curvature and Surface::conic are those of the
/// section in the yz plane.
enum class BaseForm {
    conic,  ///< conic of revolution
    biconic,  ///< (c_x x^2 + c_y y^2) / (1 + sqrt(1 - (1 + k_x) c_x^2 x^2 - (1 + k_y) c_y^2 y^2))
    toroid,  ///< the section in the yz plane, including its even terms of y, rotated about a line parallel to y
};

/// Description of the part of a surface's sag that is not a conic of revolution with even aspheric terms: another base
/// shape, and further terms, which are all added.
struct SurfaceForm {
    BaseForm base = BaseForm::conic;
    /// Biconic: curvature in the xz plane; toroid: 1 / distance from the vertex to the line of rotation; 1/mm.
    double curvature_x = 0;
    double conic_x = 0;  ///< biconic: conic constant in the xz plane
    std::vector<double> radial;  ///< coefficients of r, r^2, r^3, ...; their units are 1, mm^-1, mm^-2, ...
    std::vector<XyTerm> xy;  ///< terms of x^i y^j
    std::optional<ZernikeTerms> zernike;
    std::optional<ForbesTerms> forbes;
    std::optional<SuperconicTerms> superconic;

    bool operator==(const SurfaceForm&) const = default;

    /// True if the base is a conic of revolution.
    bool has_conic_base() const { return base == BaseForm::conic; }
    /// True if the form has terms of any kind, even if all coefficients are 0.
    bool has_terms() const;
    /// True if this form adds nothing: the base is a conic of revolution, and all coefficients are 0.
    bool adds_nothing() const;
    /// Returns the form with all lengths multiplied by `factor`.
    SurfaceForm scaled(double factor) const;
    /// Returns the form with its sag negated.
    SurfaceForm negated() const;
    /// Returns the reason why the form is not rotationally symmetric, for example "is toroidal"; empty if it is.
    std::string asymmetry() const;
};

/// Registry of the kinds of terms: pointers to the optional members of SurfaceForm that hold them. The type of each
/// member provides names, checks, the sag, and the conversion to the polynomials that are traced (the interface is
/// described in form_kind.hpp). Readers, writers, checks, derivatives and bindings iterate over this list.
inline constexpr std::tuple kFormTerms{&SurfaceForm::zernike, &SurfaceForm::forbes, &SurfaceForm::superconic};
inline constexpr std::size_t kFormTermsCount = std::tuple_size_v<decltype(kFormTerms)>;

/// Type of the terms that a std::optional of a form holds.
template <class Optional>
using TermsIn = typename std::remove_cvref_t<Optional>::value_type;

/// Calls f(optional) with the std::optional of each kind in kFormTerms, whether the form has these terms or not.
template <class Form, class F>
constexpr void for_each_kind_of_terms(Form& form, F&& f) {
    std::apply([&](auto... member) { (f(form.*member), ...); }, kFormTerms);
}

/// Calls f(terms) with the terms of each kind that the form has.
template <class Form, class F>
constexpr void for_each_present_terms(Form& form, F&& f) {
    for_each_kind_of_terms(form, [&](auto& terms) {
        if (terms) f(*terms);
    });
}

namespace form_detail {
/// Returns the names of a kind of terms.
template <class Terms>
constexpr const FormNames& names_of(std::optional<Terms> SurfaceForm::*) {
    return Terms::words;
}
/// True if `Variant` is the enumeration of the variants of a kind of terms.
template <class Variant, class Terms>
constexpr bool has_variant(std::optional<Terms> SurfaceForm::*) {
    if constexpr (requires { Terms::variant; })
        return std::is_same_v<Variant Terms::*, std::remove_const_t<decltype(Terms::variant)>>;
    return false;
}
}  // namespace form_detail

/// True if E is the enumeration of the variants of a kind of terms, such as ForbesKind. It then has two enumerators.
template <class E>
inline constexpr bool is_form_variant =
    std::apply([](auto... member) { return (form_detail::has_variant<E>(member) || ...); }, kFormTerms);

/// Names of the kinds of terms, in the order of kFormTerms.
inline constexpr std::array<FormNames, kFormTermsCount> kFormNames =
    std::apply([](auto... member) { return std::array{form_detail::names_of(member)...}; }, kFormTerms);

}  // namespace REALCAM_NAMESPACE
