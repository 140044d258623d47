// Lens.trace, on the CPU or a GPU, and the enumeration RayStatus.

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
    int surface_count;  ///< -1: all surfaces
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

/// Returns the number of rays N. Throws InputError unless both arrays have the shape (N, 3).
std::int64_t ray_count(const Doubles& origins, const Doubles& directions) {
    const bool fits = origins.ndim() == 2 && origins.shape(1) == 3 && directions.ndim() == 2 &&
                      directions.shape(1) == 3 && origins.shape(0) == directions.shape(0);
    if (!fits) throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    return origins.shape(0);
}

/// Returns the transmission as an array (N,), or None if it is not requested. It is computed in double precision
/// whatever the precision of the trace.
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

/// Traces rays in host memory. `gpu`: number of the GPU that computes; std::nullopt: the CPU.
TraceResult trace_host_arrays(const LensSystem& lens, const Doubles& origins, const Doubles& directions,
                              const TraceOptions& options, std::optional<int> gpu) {
    const std::int64_t count = ray_count(origins, directions);
    py::array_t<double> end_points({count, std::int64_t{3}}), end_directions({count, std::int64_t{3}}), path(count);
    py::array_t<int> status(count), surface(count);
    const TracedRays out{end_points.mutable_data(), end_directions.mutable_data(), path.mutable_data(),
                         status.mutable_data(), surface.mutable_data()};
    {
        const Unlocked unlocked;
        if (gpu)
            trace_rays_on_gpu(*gpu, lens, options.direction, options.wavelength_nm, options.precision,
                              options.surface_count, count, origins.data(), directions.data(), out);
        else
            trace_rays(lens, options.direction, options.wavelength_nm, options.precision, options.surface_count, count,
                       origins.data(), directions.data(), out, nullptr, heed_signals);
    }
    return {end_points, end_directions, path, status, surface, transmission_of(lens, origins, directions, options)};
}

/// Returns the GPU that holds both inputs. Throws InputError if `device` names another one.
int gpu_of(const DeviceInput& origins, const DeviceInput& directions, const std::optional<std::string>& device) {
    const int origins_gpu = origins.numbers.ordinal, directions_gpu = directions.numbers.ordinal;
    const int gpu = std::max(origins_gpu, directions_gpu);  // -1 if both arrays are empty
    if (origins_gpu >= 0 && directions_gpu >= 0 && origins_gpu != directions_gpu)
        throw InputError("origins_mm lies on cuda:" + std::to_string(origins_gpu) + " and directions on cuda:" +
                         std::to_string(directions_gpu) + "; both must lie on the same device");
    const bool any_gpu = !device || *device == "auto" || *device == "cuda";
    if (gpu >= 0 && any_gpu) return gpu;
    const std::optional<int> requested = gpu_for_rays(any_gpu ? "cuda" : *device);
    if (!requested || (gpu >= 0 && *requested != gpu))
        throw InputError("the rays lie on " + (gpu >= 0 ? "cuda:" + std::to_string(gpu) : std::string("a GPU")) +
                         ", and device is \"" + *device + "\"; device must be the one that holds the rays");
    return *requested;
}

TraceResult trace_device_arrays(const LensSystem& lens, const DeviceInput& origins, const DeviceInput& directions,
                                const TraceOptions& options, const std::optional<std::string>& device) {
    if (origins.count != directions.count)
        throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    if (options.transmission)
        throw InputError("transmission=True requires arrays in host memory, and these lie on a GPU");
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
        "Rays behind a lens, in the lens frame: numpy arrays, or DeviceArrays if the input was in a GPU's memory. See "
        "Lens.trace.");
    def_result(result, [](const TraceResult& r) {
        const py::ssize_t count = length_of(r.status);
        check_arrays('f', {count, 3}, {r.origins_mm, r.directions});
        check_arrays('f', {count}, {r.optical_path_mm});
        check_arrays('i', {count}, {r.status, r.surface_index});
        if (!r.transmission.is_none()) check_arrays('f', {count}, {r.transmission});
    });
    result
        .def_readonly(
            "origins_mm", &TraceResult::origins_mm,
            "(N, 3): intersection with the last surface that the ray reached. If status is not OK, that is the point "
            "where the ray ended.")
        .def_readonly("directions", &TraceResult::directions, "(N, 3): unit directions behind that surface.")
        .def_readonly("optical_path_mm", &TraceResult::optical_path_mm,
                      "(N,): optical path length (index times distance) from the ray's origin.")
        .def_readonly("status", &TraceResult::status, "(N,): RayStatus values.")
        .def_readonly("surface_index", &TraceResult::surface_index,
                      "(N,): index of the last surface that the ray reached, from 0; -1 for BAD_INPUT.")
        .def_readonly(
            "transmission", &TraceResult::transmission,
            R"((N,): transmitted fraction of the power of unpolarised light; 0 if status is not OK. None if it was not
requested.)")
        .def("__repr__",
             [](const TraceResult& r) { return "<realcam.TraceResult " + counted(py::len(r.status), "ray") + '>'; });
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("trace", &trace, "origins_mm"_a, "directions"_a, py::kw_only(), "wavelength_nm"_a = py::none(),
             "start"_a = "film", "dtype"_a = "float64", "surface_count"_a = py::none(), "device"_a = py::none(),
             "transmission"_a = false,
             R"(Traces rays through the lens, surface by surface.
origins_mm, directions: (N, 3), lens frame. Each ray is the whole straight line through its origin.
wavelength_nm: None: the design wavelength.
start: "film": the light travels towards the scene; "scene": towards the film.
dtype: precision of the computation, float64 or float32; results are float64 arrays.
surface_count: number of surfaces to trace, in the order in which the light reaches them; None: all.
device: for arrays in host memory: "cpu" or None, a GPU ("cuda", "cuda:1"), or "auto" for a GPU if there is one;
  results are numpy arrays. Arrays in a GPU's memory with __cuda_array_interface__ or __dlpack__ (torch, cupy,
  DeviceArray; float64 or float32, contiguous) are traced on that GPU, and the results are DeviceArrays.
transmission: also computes the transmitted power by polarisation ray tracing in float64, see Lens.transmission; only
  for arrays in host memory.
Returns a TraceResult. An invalid ray gets the status BAD_INPUT. Raises InputError for wrong shapes, and
DeviceError.)");
}

}  // namespace realcam::bindings
