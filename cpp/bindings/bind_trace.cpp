#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <optional>

#include "../embree/lens_rays.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

struct TraceResult {
    py::array_t<double> origins_mm, directions, optical_path_mm;
    py::array_t<int> status, surface_index;
};

std::int64_t ray_count(const Array& origins, const Array& directions) {
    const bool fits = origins.ndim() == 2 && origins.shape(1) == 3 && directions.ndim() == 2 &&
                      directions.shape(1) == 3 && origins.shape(0) == directions.shape(0);
    if (!fits) throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    return origins.shape(0);
}

TraceResult trace(const LensSystem& lens, const Array& origins, const Array& directions,
                  std::optional<double> wavelength_nm, const std::string& start, const py::object& dtype,
                  std::optional<int> surface_count) {
    const std::int64_t count = ray_count(origins, directions);
    if (start != "film" && start != "scene") throw InputError("start must be \"film\" or \"scene\"");
    if (surface_count && *surface_count < 1)
        throw InputError("surface_count must be 1 or more, or None for all surfaces");
    const py::dtype type = py::dtype::from_args(dtype);
    if (type.kind() != 'f' || (type.itemsize() != 4 && type.itemsize() != 8))
        throw InputError("dtype must be \"float64\" or \"float32\"");
    TraceResult result{py::array_t<double>({count, std::int64_t{3}}), py::array_t<double>({count, std::int64_t{3}}),
                       py::array_t<double>(count), py::array_t<int>(count), py::array_t<int>(count)};
    const TracedRays out{result.origins_mm.mutable_data(), result.directions.mutable_data(),
                         result.optical_path_mm.mutable_data(), result.status.mutable_data(),
                         result.surface_index.mutable_data()};
    {
        const py::gil_scoped_release release;
        trace_rays(lens, start == "film" ? LightDirection::to_scene : LightDirection::to_film,
                   wavelength_nm.value_or(lens.wavelength_nm),
                   type.itemsize() == 8 ? Precision::float64 : Precision::float32, surface_count.value_or(-1), count,
                   origins.data(), directions.data(), out);
    }
    return result;
}

}  // namespace

void bind_trace(py::module_& m) {
    const std::pair<const char*, RayStatus> statuses[] = {
        {"OK", RayStatus::ok},
        {"MISSED", RayStatus::missed},
        {"VIGNETTED", RayStatus::vignetted},
        {"TOTAL_INTERNAL_REFLECTION", RayStatus::total_internal_reflection},
        {"NO_CONVERGENCE", RayStatus::no_convergence},
        {"BAD_INPUT", RayStatus::bad_input},
    };
    py::dict values;
    for (const auto& [name, status] : statuses) values[name] = static_cast<int>(status);
    m.attr("RayStatus") = py::module_::import("enum").attr("IntEnum")("RayStatus", values, "module"_a = "realcam");
    py::class_<TraceResult>(m, "TraceResult", "Rays after a lens, lens frame.")
        .def_readonly("origins_mm", &TraceResult::origins_mm, "(N, 3): on the last surface met.")
        .def_readonly("directions", &TraceResult::directions, "(N, 3), unit.")
        .def_readonly("optical_path_mm", &TraceResult::optical_path_mm, "(N,): index times distance, from the origin.")
        .def_readonly("status", &TraceResult::status, "(N,): RayStatus values.")
        .def_readonly("surface_index", &TraceResult::surface_index,
                      "(N,): surface at which the ray ended, from 0; -1: bad input.");
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("trace", &trace, "origins_mm"_a, "directions"_a, py::kw_only(), "wavelength_nm"_a = py::none(),
             "start"_a = "film", "dtype"_a = "float64", "surface_count"_a = py::none(),
             "Traces rays surface by surface. origins_mm, directions: (N, 3), lens frame.\n"
             "start: \"film\" (towards the scene) or \"scene\" (towards the film).\n"
             "dtype: number type of the computation, float64 or float32; results are float64 arrays.\n"
             "surface_count: cross only the first so many surfaces that the light meets; None: all.\n"
             "Returns a TraceResult. Raises InputError for wrong shapes; single bad rays end as BAD_INPUT.");
}

}  // namespace realcam::bindings
