#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "../../cuda/rays/cuda_rays.hpp"
#include "../../devices/devices.hpp"
#include "../../embree/lens_rays.hpp"
#include "../../optics/coating/polarised_ray.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/device_array.hpp"
#include "../values/restored.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Doubles = InputArray<double>;

/// Traced rays as numpy arrays or DeviceArrays.
struct TraceResult {
    Typed<"_Doubles"> origins_mm, directions, optical_path_mm;
    Typed<"_Integers"> status, surface_index;
    Typed<"NDArray[float64] | None"> transmission;
};

/// Validated options of a trace.
struct TraceOptions {
    LightDirection direction;
    double wavelength_nm;
    Precision precision;
    int surface_count;
    bool transmission;
};

TraceOptions options_of(const LensSystem& lens, std::optional<double> wavelength_nm, const std::string& start,
                        const py::object& dtype, std::optional<int> surface_count, bool transmission) {
    if (start != "film" && start != "scene") throw InputError("start must be \"film\" or \"scene\"");
    if (surface_count && *surface_count < 1)
        throw InputError("surface_count must be 1 or more, or None for all surfaces");
    const py::dtype type = py::dtype::from_args(dtype);
    if (type.kind() != 'f' || (type.itemsize() != 4 && type.itemsize() != 8))
        throw InputError("dtype must be \"float64\" or \"float32\"");
    return {start == "film" ? LightDirection::to_scene : LightDirection::to_film,
            wavelength_nm.value_or(lens.wavelength_nm), type.itemsize() == 8 ? Precision::float64 : Precision::float32,
            surface_count.value_or(-1), transmission};
}

std::int64_t ray_count(const Doubles& origins, const Doubles& directions) {
    const bool fits = origins.ndim() == 2 && origins.shape(1) == 3 && directions.ndim() == 2 &&
                      directions.shape(1) == 3 && origins.shape(0) == directions.shape(0);
    if (!fits) throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    return origins.shape(0);
}

/// Returns an array (N,), or None if it is not requested. Computed in double precision whatever the precision of the
/// trace.
py::object transmission_of(const LensSystem& lens, const Doubles& origins, const Doubles& directions,
                           const TraceOptions& options) {
    if (!options.transmission) return py::none();
    const auto count = static_cast<std::size_t>(origins.shape(0));
    py::array_t<double> result(origins.shape(0));
    double* to = result.mutable_data();
    {
        const Unlocked unlocked;
        const PolarisedTrace trace(lens, options.direction, options.wavelength_nm, options.surface_count);
        parallel_ray_loop(heed_signals).for_all(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const double *o = origins.data() + 3 * i, *d = directions.data() + 3 * i;
                to[i] = trace({o[0], o[1], o[2]}, {d[0], d[1], d[2]}).traced;
            }
        });
    }
    return result;
}

TraceResult trace_host_arrays(const LensSystem& lens, const Doubles& origins, const Doubles& directions,
                              const TraceOptions& options, std::optional<int> gpu) {
    const std::int64_t count = ray_count(origins, directions);
    py::array_t<double> to({count, std::int64_t{3}}), towards({count, std::int64_t{3}}), path(count);
    py::array_t<int> status(count), surface(count);
    const TracedRays out{to.mutable_data(), towards.mutable_data(), path.mutable_data(), status.mutable_data(),
                         surface.mutable_data()};
    {
        const Unlocked unlocked;
        if (gpu)
            trace_rays_on_gpu(*gpu, lens, options.direction, options.wavelength_nm, options.precision,
                              options.surface_count, count, origins.data(), directions.data(), out);
        else
            trace_rays(lens, options.direction, options.wavelength_nm, options.precision, options.surface_count, count,
                       origins.data(), directions.data(), out, nullptr, heed_signals);
    }
    return {to, towards, path, status, surface, transmission_of(lens, origins, directions, options)};
}

/// Returns the GPU that holds both inputs. Throws InputError if `device` names another one.
int gpu_of(const DeviceInput& origins, const DeviceInput& directions, const std::optional<std::string>& device) {
    const int from = origins.numbers.ordinal, along = directions.numbers.ordinal, there = std::max(from, along);
    if (from >= 0 && along >= 0 && from != along)
        throw InputError("origins_mm lies on cuda:" + std::to_string(from) +
                         " and directions on cuda:" + std::to_string(along) + "; both must lie on the same device");
    const bool any = !device || *device == "auto" || *device == "cuda";
    if (there >= 0 && any) return there;
    const std::optional<int> asked = gpu_for_rays(any ? "cuda" : *device);
    if (!asked || (there >= 0 && *asked != there))
        throw InputError("the rays lie on " + (there >= 0 ? "cuda:" + std::to_string(there) : std::string("a GPU")) +
                         ", and device is \"" + *device + "\"; rays are traced where they lie");
    return *asked;
}

TraceResult trace_device_arrays(const LensSystem& lens, const DeviceInput& origins, const DeviceInput& directions,
                                const TraceOptions& options, const std::optional<std::string>& device) {
    if (origins.count != directions.count)
        throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    if (options.transmission)
        throw InputError("transmission is worked out for arrays of the host only, and these lie on a GPU");
    ForeignNumbers from = origins.numbers, along = directions.numbers;
    from.ordinal = along.ordinal = gpu_of(origins, directions, device);
    const TracedArrays traced = [&] {
        const Unlocked unlocked;
        return trace_arrays(lens, options.direction, options.wavelength_nm, options.precision, options.surface_count,
                            origins.count, from, along);
    }();
    return {py::cast(traced.origins), py::cast(traced.directions),    py::cast(traced.optical_path),
            py::cast(traced.status),  py::cast(traced.surface_index), py::none()};
}

TraceResult trace(const LensSystem& lens, const ArrayLike& origins, const ArrayLike& directions,
                  std::optional<double> wavelength_nm, const std::string& start, const DTypeLike& dtype,
                  std::optional<int> surface_count, const std::optional<std::string>& device, bool transmission) {
    const TraceOptions options = options_of(lens, wavelength_nm, start, dtype, surface_count, transmission);
    const auto from = device_input(origins, "origins_mm"), along = device_input(directions, "directions");
    if (from && along) return trace_device_arrays(lens, *from, *along, options, device);
    if (from || along)
        throw InputError("origins_mm and directions must lie on the same device, and only " +
                         std::string(from ? "origins_mm" : "directions") + " lies on a GPU");
    return trace_host_arrays(lens, Doubles(origins), Doubles(directions), options,
                             device ? gpu_for_rays(*device) : std::nullopt);
}

}  // namespace

template <>
struct RestoredCheck<TraceResult> {
    static void check(const TraceResult& result) {
        const py::ssize_t count = restored_length(result.status);
        for (const py::object* vectors : {&result.origins_mm, &result.directions})
            check_restored_array(*vectors, {'f', {count, 3}});
        check_restored_array(result.optical_path_mm, {'f', {count}});
        for (const py::object* numbers : {&result.status, &result.surface_index})
            check_restored_array(*numbers, {'i', {count}});
        if (!result.transmission.is_none()) check_restored_array(result.transmission, {'f', {count}});
    }
};

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
    py::class_<TraceResult> result(
        m, "TraceResult",
        "Rays after a lens, lens frame. Arrays of numpy; DeviceArrays where the rays came in a GPU's memory.");
    def_result(result);
    result
        .def_readonly(
            "origins_mm", &TraceResult::origins_mm,
            "(N, 3): on the last surface met. Of a ray whose status is not OK, where it ended: ask status before "
            "you use it.")
        .def_readonly("directions", &TraceResult::directions, "(N, 3), unit.")
        .def_readonly("optical_path_mm", &TraceResult::optical_path_mm, "(N,): index times distance, from the origin.")
        .def_readonly("status", &TraceResult::status, "(N,): RayStatus values.")
        .def_readonly("surface_index", &TraceResult::surface_index,
                      "(N,): surface at which the ray ended, from 0; -1: bad input.")
        .def_readonly(
            "transmission", &TraceResult::transmission,
            R"((N,): share of the power of unpolarised light that is left, 0 where the status is not OK; None where it
was not asked for.)")
        .def("__repr__",
             [](const TraceResult& r) { return "<realcam.TraceResult " + counted(py::len(r.status), "ray") + '>'; });
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("trace", &trace, "origins_mm"_a, "directions"_a, py::kw_only(), "wavelength_nm"_a = py::none(),
             "start"_a = "film", "dtype"_a = "float64", "surface_count"_a = py::none(), "device"_a = py::none(),
             "transmission"_a = false,
             R"(Traces rays surface by surface. origins_mm, directions: (N, 3), lens frame.
start: "film" (towards the scene) or "scene" (towards the film).
dtype: number type of the computation, float64 or float32; results are float64 arrays.
surface_count: cross only the first so many surfaces that the light meets; None: all.
device: for arrays of the host the CPU (None, "cpu"), a GPU ("cuda", "cuda:1"), or a GPU if there is
one ("auto"); results are arrays of numpy. Arrays with __cuda_array_interface__ or __dlpack__ in a GPU's
memory (torch, cupy, DeviceArray: float64 or float32, contiguous) are traced where they lie, and the
results are DeviceArrays.
transmission: work out transmission too, by polarisation ray tracing in float64, as Lens.transmission does; for
arrays of the host.
Returns a TraceResult. Raises InputError for wrong shapes, DeviceError; single bad rays end as BAD_INPUT.)");
}

}  // namespace realcam::bindings
