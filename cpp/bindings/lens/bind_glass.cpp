// The Python class Glass.

#include <pybind11/stl.h>

#include "../../io/lens/lens_glass.hpp"
#include "../bindings.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

Glass glass_from(const py::object& material) {
    if (material.is_none()) return Glass::air();
    if (py::isinstance<Glass>(material)) return material.cast<Glass>();
    if (py::isinstance<py::str>(material)) return io::catalogue_glass(material.cast<std::string>());
    if (py::isinstance<py::sequence>(material)) {
        std::vector<double> pair;
        try {
            pair = material.cast<std::vector<double>>();
        } catch (const py::cast_error&) {
            // Values that are not pairs of numbers are reported below.
        }
        if (pair.size() != 2) throw InputError("a material given as a pair must be (n_d, V_d)");
        Glass glass = Glass::from_abbe_number(pair[0], pair[1]);
        glass.label = py::str(material).cast<std::string>();
        return glass;
    }
    double index = 0;
    try {
        index = material.cast<double>();
    } catch (const py::cast_error&) {
        throw InputError("a material must be an index, (n_d, V_d), the name of a glass, a Glass or None (air)");
    }
    Glass glass = Glass::constant(index);
    if (index != 1) glass.label = py::str(material).cast<std::string>();
    return glass;
}

std::string glass_text(const Glass& glass) {
    return glass.label.empty() ? glass.is_air() ? "air" : "index " + digits(glass.index(kLineD_nm))
                               : shortened(glass.label);
}

void bind_glass(py::module_& m) {
    py::class_<Glass> glass(m, "Glass",
                            "Optical medium: refractive index relative to air as a function of wavelength.");
    def_hashable_value(glass);
    glass
        .def_static(
            "constant",
            [](double index) {
                if (!(index >= 1) || !std::isfinite(index))
                    throw InputError("expected a refractive index of at least 1");
                return Glass::constant(index);
            },
            "index"_a, "Returns a medium with the same index at every wavelength. Raises InputError below 1.")
        .def_static("from_abbe_number", &Glass::from_abbe_number, "n_d"_a, "abbe_number"_a,
                    R"(Returns a two-term Cauchy glass with this index at the d line and this Abbe number
V_d = (n_d - 1)/(n_F - n_C). Raises InputError for an index below 1 or an Abbe number that is not positive.)")
        .def_static("cauchy", &Glass::cauchy, "coefficients"_a,
                    "Returns a glass with n = A + B/l^2 + C/l^4 + ..., l the wavelength in um. coefficients: [A, B, "
                    "C, ...]. Raises InputError if the list is empty.")
        .def_static(
            "sellmeier",
            [](const std::vector<double>& b, const std::vector<double>& c) {
                if (b.size() != c.size() || b.empty())
                    throw InputError("B and C must have the same number of coefficients, at least one");
                std::vector<Glass::SellmeierTerm> terms;
                for (std::size_t i = 0; i < b.size(); ++i) terms.push_back({b[i], c[i]});
                return Glass::sellmeier(terms);
            },
            "B"_a, "C"_a,
            "Returns a glass with n^2 = 1 + sum of B l^2/(l^2 - C), l the wavelength in um, C in um^2. Raises "
            "InputError.")
        .def_static(
            "table",
            [](const std::vector<std::pair<double, double>>& points) {
                std::vector<Glass::TablePoint> list;
                for (const auto& [wavelength, index] : points) list.push_back({wavelength, index});
                return Glass::table(std::move(list));
            },
            "points"_a, "Returns a glass interpolated between (wavelength_nm, index) pairs. Raises InputError.")
        .def_static(
            "named", &io::catalogue_glass, "name"_a,
            "Returns a glass of the catalogue, such as \"N-BK7\" or \"schott:F4\". Raises InputError with the most "
            "similar names.")
        .def("index", &Glass::index, "wavelength_nm"_a,
             "Returns the refractive index relative to air; nan if the formula has no real value at that wavelength.")
        .def_readonly("label", &Glass::label,
                      "Name, index or pair from which the glass was created, as text; empty for air.")
        .def("__repr__", [](const Glass& g) { return "<realcam.Glass " + glass_text(g) + '>'; });
    m.def("glass_names", &io::catalogue_full_names,
          "Returns the names of the glasses of the catalogue, such as \"schott:N-BK7\".");
}

}  // namespace realcam::bindings
