#pragma once
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../optics/prescription/surface.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

/// Terms of each row of kFormTerms as dicts; omitted ones are left unchanged.
using TermsDicts = std::array<std::optional<py::dict>, kFormTermsCount>;

/// Changes of a surface's form and aperture; omitted ones are left unchanged.
struct FormChanges {
    using Number = std::optional<double>;
    std::optional<std::string> form;
    Number radius_of_curvature_x_mm, conic_x;
    std::optional<std::map<int, double>> radial_terms;
    std::optional<std::map<std::pair<int, int>, double>> xy_terms;
    TermsDicts terms;
    std::optional<py::dict> aperture;
    std::optional<std::vector<py::dict>> obscurations;
};

/// Applies changes to a surface. An empty dict removes the respective form or aperture. Throws InputError for an
/// invalid name, key or value.
void change_form(Surface& surface, const FormChanges& to);

/// Returns the values in the format that change_form accepts.
std::string form_name(const Surface& surface);
std::map<int, double> radial_terms_of(const Surface& surface);
std::map<std::pair<int, int>, double> xy_terms_of(const Surface& surface);
/// `row`: of kFormTerms. Empty if the surface has no such terms.
py::dict terms_of(const Surface& surface, std::size_t row);
py::dict aperture_of(const Surface& surface);
std::vector<py::dict> obscurations_of(const Surface& surface);

}  // namespace realcam::bindings
