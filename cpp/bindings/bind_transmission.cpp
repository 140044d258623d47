#include <pybind11/stl.h>

#include "../embree/lens_rays.hpp"
#include "../optics/analysis/transmission.hpp"
#include "../optics/coating/coated_faces.hpp"
#include "analysis_arguments.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

double transmission(const LensSystem& lens, double field_deg, std::optional<double> wavelength_nm,
                    std::optional<double> object_distance_m, const std::string& polarisation,
                    const std::string& pattern, int samples, const std::optional<InputArray<double>>& pupil) {
    if (polarisation != "traced" && polarisation != "averaged")
        throw InputError("unknown polarisation \"" + polarisation + "\"; traced or averaged is wanted");
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    std::vector<PupilPoint> points = pattern_from(pattern, samples, pupil);
    const Unlocked unlocked;
    const BundleTransmission bundle = bundle_transmission(lens, wavelength, field_from(field_deg, object_distance_m),
                                                          std::move(points), parallel_ray_loop(heed_signals));
    return polarisation == "traced" ? bundle.mean_traced : bundle.mean_averaged;
}

}  // namespace

void bind_transmission(py::module_& m) {
    static const std::string text =
        std::string(
            R"(Share of the power of unpolarised light that the lens lets through, of the light of one object point that passes
the rims: the mean over the part of the stop that it fills. Fresnel's or the films' losses at every surface; glass
itself absorbs nothing here. Surfaces of which the lens does not say how they are coated (unknown_coatings) are taken
for bare glass, mirrors for perfect ones.
)") + kFieldText +
        R"(polarisation: "traced" follows both polarisations through the lens; "averaged" takes the mean of s and p at each
  surface, as if light were unpolarised between them.
)" + kPatternText +
        "Raises InputError where no ray passes, or a material is not known at that wavelength.";
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("transmission", &transmission, "field_deg"_a = 0.0, "wavelength_nm"_a = py::none(), py::kw_only(),
             "object_distance_m"_a = py::none(), "polarisation"_a = "traced", "pattern"_a = "rings", "samples"_a = 8,
             "pupil"_a = py::none(), text.c_str())
        .def_property_readonly(
            "t_stop", [](const LensSystem& lens) { return t_stop(lens, lens.wavelength_nm); },
            R"(f-number / sqrt(transmittance) at the design wavelength, the transmittance being that of the ray along
the axis times the share of the pupil that no central obstruction takes: the f-number of a lens without losses that
gives as bright a picture there. inf where the lens has no f-number.)")
        .def_property_readonly(
            "unknown_coatings", &surfaces_with_unknown_coating,
            R"(Indices of the surfaces of which the lens does not say how they are coated: glass in air, taken for bare,
and mirrors, taken for perfect. Cemented faces are bare without being said so.)");
}

}  // namespace realcam::bindings
