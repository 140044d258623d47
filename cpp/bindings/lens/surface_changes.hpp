// Keyword arguments that describe changes of a surface, shared by Surface(), Surface.replace and Lens.with_surface.

#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../optics/prescription/coating.hpp"
#include "../../optics/prescription/surface.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

/// Terms of the sag as dicts, one for each kind of terms in kFormTerms (surface_form.hpp). std::nullopt: unchanged; an
/// empty dict removes the terms.
using TermsDicts = std::array<std::optional<FormDict>, kFormTermsCount>;

/// Changes of a surface's form and aperture, as the arguments of Surface(); std::nullopt: unchanged.
struct FormChanges {
    using Number = std::optional<double>;
    std::optional<std::string> form;
    Number radius_of_curvature_x_mm, conic_x;
    std::optional<std::map<int, double>> radial_terms;
    std::optional<std::map<std::pair<int, int>, double>> xy_terms;
    TermsDicts terms;
    std::optional<FormDict> aperture;
    std::optional<std::vector<FormDict>> obscurations;
};

/// Applies changes to a surface. An empty dict removes the respective terms or aperture. Throws InputError for an
/// invalid name, key or value.
void change_form(Surface& surface, const FormChanges& changes);

// Values of a surface in the format of FormChanges.

/// Returns "conic", "biconic" or "toroid".
std::string form_name(const Surface& surface);
/// Returns coefficients of r^N by the power N, without those that are 0.
std::map<int, double> stored_radial_terms(const Surface& surface);
/// Returns coefficients of x^i y^j by the powers (i, j).
std::map<std::pair<int, int>, double> stored_xy_terms(const Surface& surface);
/// Returns the terms of the kind at an index of kFormTerms; empty if the surface has no such terms.
FormDict terms_of(const Surface& surface, std::size_t kind);
/// Returns the shape of the aperture; empty if it is the circle of the clear semi-diameter.
FormDict aperture_of(const Surface& surface);
std::vector<FormDict> obscurations_of(const Surface& surface);

/// Medium of a changed surface. `...` means unchanged, because None is air.
using MediumChange = Typed<"float | tuple[float, float] | str | Glass | types.EllipsisType | None">;

/// Changes of a surface, as the arguments of Surface(); std::nullopt: unchanged.
struct SurfaceChanges {
    using Number = std::optional<double>;
    using Numbers = std::optional<std::vector<double>>;
    using Name = std::optional<std::string>;
    using Dict = std::optional<FormDict>;
    using Dicts = std::optional<std::vector<FormDict>>;
    using RadialTerms = std::optional<std::map<int, double>>;
    using XyTerms = std::optional<std::map<std::pair<int, int>, double>>;

    Number radius_of_curvature_mm, thickness_mm;
    std::optional<Glass> material;
    Number clear_semi_diameter_mm, conic;
    RadialTerms aspheric_coefficients;
    Number inner_semi_diameter_mm;
    Name type;
    std::optional<Coating> coating;
    Numbers decentre_mm, tilt_deg;
    std::optional<bool> returns;
    FormChanges form;
};

/// Returns the changed surface. Throws InputError for invalid values.
Surface changed_surface(Surface surface, const SurfaceChanges& changes);

/// The type int, for parameter packs with one int for each type.
template <class>
using IntFor = int;
/// Type of a dict of terms, for parameter packs with one dict for each index of kFormTerms.
template <std::size_t>
using TermsDict = SurfaceChanges::Dict;

/// The indices of kFormTerms.
inline constexpr std::make_index_sequence<kFormTermsCount> kFormTermsIndices;

namespace surface_changes_detail {

template <class T, class Function, std::size_t... kind, class... First>
void def(std::index_sequence<kind...>, py::class_<T>& type, const char* name, Function function, const char* text,
         First... first) {
    using C = SurfaceChanges;
    using namespace py::literals;
    type.def(
        name,
        [function](const T& self, IntFor<First>... indices, C::Number radius, C::Number thickness,
                   const MediumChange& material, C::Number clear, C::Number conic, const C::RadialTerms& aspheric,
                   C::Number inner, const C::Name& surface_type, const Typed<"str | Coating | None">& coating,
                   const C::Numbers& decentre, const C::Numbers& tilt, std::optional<bool> returns, const C::Name& form,
                   C::Number radius_x, C::Number conic_x, const C::RadialTerms& radial, const C::XyTerms& xy,
                   const TermsDict<kind>&... terms, const C::Dict& aperture, const C::Dicts& obscurations) {
            const bool keeps_material = material.is(py::ellipsis());
            const SurfaceChanges changes{radius,
                                         thickness,
                                         keeps_material ? std::nullopt : std::optional(glass_from(material)),
                                         clear,
                                         conic,
                                         aspheric,
                                         inner,
                                         surface_type,
                                         coating.is_none() ? std::nullopt : std::optional(coating_from(coating)),
                                         decentre,
                                         tilt,
                                         returns,
                                         {form, radius_x, conic_x, radial, xy, {terms...}, aperture, obscurations}};
            return function(self, indices..., changes);
        },
        first..., py::kw_only(), "radius_of_curvature_mm"_a = py::none(), "thickness_mm"_a = py::none(),
        "material"_a = py::ellipsis(), "clear_semi_diameter_mm"_a = py::none(), "conic"_a = py::none(),
        "aspheric_coefficients"_a = py::none(), "inner_semi_diameter_mm"_a = py::none(), "type"_a = py::none(),
        "coating"_a = py::none(), "decentre_mm"_a = py::none(), "tilt_deg"_a = py::none(), "returns"_a = py::none(),
        "form"_a = py::none(), "radius_of_curvature_x_mm"_a = py::none(), "conic_x"_a = py::none(),
        "radial_terms"_a = py::none(), "xy_terms"_a = py::none(), (py::arg(kFormNames[kind].key) = py::none())...,
        "aperture"_a = py::none(), "obscurations"_a = py::none(), text);
}

}  // namespace surface_changes_detail

/// Defines a method with integer arguments named `first` and, by keyword, the arguments of Surface(). It calls
/// function(self, first..., SurfaceChanges). Arguments that the caller omits are left unchanged. `text`: docstring.
template <class T, class Function, class... First>
void def_surface_changes(py::class_<T>& type, const char* name, Function function, const char* text, First... first) {
    surface_changes_detail::def(kFormTermsIndices, type, name, function, text, first...);
}

}  // namespace realcam::bindings
