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
    py::class_<Glass> glass(m, "Glass", "An optical medium: refractive index relative to air, by wavelength.");
    def_hashable_value(glass);
    glass
        .def_static(
            "constant",
            [](double index) {
                if (!(index >= 1) || !std::isfinite(index))
                    throw InputError("expected a refractive index of at least 1");
                return Glass::constant(index);
            },
            "index"_a, "The same index at every wavelength.")
        .def_static(
            "from_abbe_number", &Glass::from_abbe_number, "n_d"_a, "abbe_number"_a,
            R"(Two-term Cauchy glass with this index at the d line and this Abbe number V_d = (n_d - 1)/(n_F - n_C).
Raises InputError for an index below 1 or a number that is not positive.)")
        .def_static("cauchy", &Glass::cauchy, "coefficients"_a,
                    "n = A + B/l^2 + C/l^4 + ..., l in um. Raises InputError where there is no coefficient.")
        .def_static(
            "sellmeier",
            [](const std::vector<double>& b, const std::vector<double>& c) {
                if (b.size() != c.size() || b.empty()) throw InputError("sellmeier needs equally many B and C");
                std::vector<Glass::SellmeierTerm> terms;
                for (std::size_t i = 0; i < b.size(); ++i) terms.push_back({b[i], c[i]});
                return Glass::sellmeier(terms);
            },
            "B"_a, "C"_a, "n^2 = 1 + sum B l^2/(l^2 - C), l in um, C in um^2.")
        .def_static(
            "table",
            [](const std::vector<std::pair<double, double>>& points) {
                std::vector<Glass::TablePoint> list;
                for (const auto& [wavelength, index] : points) list.push_back({wavelength, index});
                return Glass::table(std::move(list));
            },
            "points"_a, "Interpolated (wavelength_nm, index) pairs.")
        .def_static("named", &io::catalogue_glass, "name"_a,
                    "A glass of the catalogue, \"N-BK7\" or \"schott:F4\". Raises InputError with the nearest names.")
        .def("index", &Glass::index, "wavelength_nm"_a, "Refractive index.")
        .def_readonly("label", &Glass::label, "As it was written: a name, a number, a pair; empty for air.")
        .def("__repr__", [](const Glass& g) { return "<realcam.Glass " + glass_text(g) + '>'; });
    m.def("glass_names", &io::catalogue_full_names, "Names of the glasses of the catalogue, as \"schott:N-BK7\".");
}

}  // namespace realcam::bindings
