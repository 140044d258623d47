// Derivatives of rays by the variables of a lens and by the rays themselves, for realcam.derivatives.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../embree/lens_rays.hpp"
#include "../../optics/derivatives/adjoint_path.hpp"
#include "../../optics/derivatives/dual_path.hpp"
#include "../../optics/trace/trace_request.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "lens_variables.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

const std::map<std::string, LensQuantity>& quantities() {
    static const std::map<std::string, LensQuantity> names = {
        {"curvature", LensQuantity::curvature},
        {"conic", LensQuantity::conic},
        {"aspheric", LensQuantity::aspheric},
        {"thickness", LensQuantity::thickness},
        {"index", LensQuantity::index},
        {"decentre", LensQuantity::decentre},
        {"tilt", LensQuantity::tilt},
        {"curvature_x", LensQuantity::curvature_x},
        {"conic_x", LensQuantity::conic_x},
        {"radial", LensQuantity::radial},
        {"xy", LensQuantity::xy},
        {"film_distance", LensQuantity::film_distance},
    };
    return names;
}

}  // namespace

std::vector<LensVariable> variables_from(const Variables& variables) {
    std::vector<LensVariable> list;
    for (const auto& [name, surface, number, number_y] : variables) {
        const auto has_name = [&](const FormNames& words) { return name == words.key; };
        const auto terms = std::find_if(kFormNames.begin(), kFormNames.end(), has_name);
        if (terms != kFormNames.end()) {
            const auto index = static_cast<int>(terms - kFormNames.begin());
            list.push_back({LensQuantity::terms, surface, number, number_y, index});
            continue;
        }
        const auto found = quantities().find(name);
        if (found == quantities().end()) {
            std::string all;
            for (const auto& [known, quantity] : quantities()) all += known + ", ";
            for (const FormNames& words : kFormNames) all += words.key + std::string(", ");
            throw InputError("unknown quantity \"" + name + "\"; expected one of " + all.substr(0, all.size() - 2));
        }
        list.push_back({found->second, surface, number, number_y});
    }
    return list;
}

namespace {

constexpr int kPathRow = 6;  ///< row of the optical path in RayDerivatives

/// Writes the derivatives of the seven numbers of a traced ray by the caller's `origin` and `direction` (not unit), an
/// array (7, 6). They follow by the chain rule from those by the start point `entry.origin` on the same line and by
/// the optical direction (index times unit direction). `index`: refractive index in front of the lens.
void write_by_ray(const RayDerivatives& ray, Vec3d direction, const LensEntry& entry, double index, Vec3d origin,
                  double* out) {
    const double size = length(direction);
    const Vec3d unit = (1 / size) * direction;
    const double distance = dot(entry.origin - origin, unit) / size;  // entry.origin = origin + distance * direction
    for (int row = 0; row < RayDerivatives::kNumbers; ++row) {
        const double* by = ray.by_start[row];
        const Vec3d by_origin{by[0], by[1], by[2]}, by_optical{by[3], by[4], by[5]};
        Vec3d by_direction = (index / size) * (by_optical - dot(by_optical, unit) * unit) + distance * by_origin;
        // The path from the caller's origin to the start point depends on the length of `direction`.
        if (row == kPathRow) by_direction = by_direction + index * distance * unit;
        const double numbers[6] = {by_origin.x,    by_origin.y,    by_origin.z,
                                   by_direction.x, by_direction.y, by_direction.z};
        std::copy(numbers, numbers + 6, out + 6 * row);
    }
}

/// Returns the number of rays N. Throws InputError unless both arrays have the shape (N, 3).
py::ssize_t count_rays(const InputArray<double>& origins, const InputArray<double>& directions) {
    const bool fits = origins.ndim() == 2 && origins.shape(1) == 3 && directions.ndim() == 2 &&
                      directions.shape(1) == 3 && origins.shape(0) == directions.shape(0);
    if (!fits) throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    return origins.shape(0);
}

LightDirection light_direction_from(const std::string& start) {
    if (start != "film" && start != "scene") throw InputError("start must be \"film\" or \"scene\"");
    return start == "film" ? LightDirection::to_scene : LightDirection::to_film;
}

/// Returns the derivatives of a scalar function by the variables (V,), and by the rays' origins and directions (N, 3).
/// `of_origins`, `of_directions`, `of_paths`: its derivatives by the origins, directions and paths of the traced rays.
Typed<"tuple[NDArray[float64], NDArray[float64], NDArray[float64]]", py::tuple> backpropagate_rays(
    const LensSystem& lens, const InputArray<double>& origins, const InputArray<double>& directions,
    const Variables& variables, const InputArray<double>& of_origins, const InputArray<double>& of_directions,
    const InputArray<double>& of_paths, std::optional<double> wavelength_nm, const std::string& start) {
    const py::ssize_t count = count_rays(origins, directions);
    for (const InputArray<double>* array : {&of_origins, &of_directions})
        if (array->ndim() != 2 || array->shape(0) != count || array->shape(1) != 3)
            throw InputError("of_origins and of_directions must be arrays of shape (N, 3), like origins_mm");
    if (of_paths.ndim() != 1 || of_paths.shape(0) != count)
        throw InputError("of_optical_paths must be an array of shape (N,), one number for each ray");
    const AdjointPath path(lens, light_direction_from(start), wavelength_or_design(lens, wavelength_nm),
                           variables_from(variables));
    py::array_t<double> by_origins({count, py::ssize_t{3}}), by_directions({count, py::ssize_t{3}});
    const AdjointRequest request{static_cast<std::size_t>(count),
                                 origins.data(),
                                 directions.data(),
                                 of_origins.data(),
                                 of_directions.data(),
                                 of_paths.data(),
                                 by_origins.mutable_data(),
                                 by_directions.mutable_data()};
    const std::vector<double> by_variables = [&] {
        const Unlocked unlocked;
        return path.gradient(request, parallel_ray_loop(heed_signals, 1));
    }();
    return py::make_tuple(py::array_t<double>(static_cast<py::ssize_t>(by_variables.size()), by_variables.data()),
                          by_origins, by_directions);
}

/// Returns the status (N,), numbers (N, 7), and their derivatives by the variables (N, 7, V) and by the input rays
/// (N, 7, 6); see the docstring. NaN if the status is not OK. `rims`: false if rims block no rays.
Typed<"tuple[NDArray[int32], NDArray[float64], NDArray[float64], NDArray[float64]]", py::tuple> ray_derivatives(
    const LensSystem& lens, const InputArray<double>& origins, const InputArray<double>& directions,
    const Variables& variables, std::optional<double> wavelength_nm, const std::string& start, const std::string& frame,
    std::optional<int> surface_count, bool rims) {
    const py::ssize_t count = count_rays(origins, directions);
    const DualPath path(lens, light_direction_from(start), wavelength_or_design(lens, wavelength_nm),
                        variables_from(variables),
                        frame == "lens"   ? ExitFrame::lens
                        : frame == "film" ? ExitFrame::film
                                          : ExitFrame::last_axis,
                        rims);
    const int all = path.surface_count(), surfaces = surface_count.value_or(all);
    if (surfaces < 1 || surfaces > all) throw InputError("surface_count must lie between 1 and " + std::to_string(all));
    constexpr py::ssize_t kNumbers = RayDerivatives::kNumbers;
    const auto width = static_cast<py::ssize_t>(path.variable_count());
    py::array_t<int> status(count);
    py::array_t<double> numbers({count, kNumbers}), by_variable({count, kNumbers, width}),
        by_ray({count, kNumbers, py::ssize_t{6}});
    int* to_status = status.mutable_data();
    double *to_numbers = numbers.mutable_data(), *to_variables = by_variable.mutable_data(),
           *to_ray = by_ray.mutable_data();
    {
        const Unlocked unlocked;
        parallel_ray_loop(heed_signals)
            .for_all(static_cast<std::size_t>(count), [&](std::size_t first, std::size_t last) {
                constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
                DualPath::Tape tape;
                RayDerivatives ray;
                for (std::size_t i = first; i < last; ++i) {
                    const double *o = origins.data() + 3 * i, *d = directions.data() + 3 * i;
                    const Vec3d origin{o[0], o[1], o[2] - path.entry_position()}, direction{d[0], d[1], d[2]};
                    const LensEntry entry = enter_lens(origin, direction, path.entry_index(), path.entry_reach());
                    RayStatus end = entry.status;
                    if (end == RayStatus::ok) end = path.trace(entry.origin, entry.direction, tape, surfaces);
                    to_status[i] = static_cast<int>(end);
                    // Numbers per ray: origin, direction and path; and derivatives of them by all variables.
                    const std::size_t per_ray = kNumbers, per_ray_by_variable = per_ray * path.variable_count();
                    if (end != RayStatus::ok) {
                        std::fill_n(to_numbers + per_ray * i, per_ray, kNone);
                        std::fill_n(to_variables + per_ray_by_variable * i, per_ray_by_variable, kNone);
                        std::fill_n(to_ray + 6 * per_ray * i, 6 * per_ray, kNone);
                        continue;
                    }
                    if (surfaces == all)
                        path.derivatives(tape, ray);
                    else
                        path.derivatives_behind(tape, surfaces, ray);
                    const double ray_numbers[] = {ray.origin.x,
                                                  ray.origin.y,
                                                  ray.origin.z,
                                                  ray.direction.x,
                                                  ray.direction.y,
                                                  ray.direction.z,
                                                  ray.path + entry.optical_path};
                    std::copy(ray_numbers, ray_numbers + per_ray, to_numbers + per_ray * i);
                    double* row = to_variables + per_ray_by_variable * i;
                    for (std::size_t k = 0; k < per_ray; ++k)
                        for (std::size_t v = 0; v < per_ray_by_variable; v += per_ray) *row++ = ray.by_variable[v + k];
                    write_by_ray(ray, direction, entry, path.entry_index(), origin, to_ray + 6 * per_ray * i);
                }
            });
    }
    return py::make_tuple(status, numbers, by_variable, by_ray);
}

}  // namespace

void bind_derivatives(py::module_& m) {
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("_ray_derivatives", &ray_derivatives, "origins_mm"_a, "directions"_a, "variables"_a, py::kw_only(),
             "wavelength_nm"_a = py::none(), "start"_a = "film", "frame"_a = "lens", "surface_count"_a = py::none(),
             "rims"_a = true,
             R"(Internal: use realcam.ray_derivatives.
variables: tuples (quantity, surface, number, number_y). surface: index from 0; number: power of r, index of the
coefficient or axis, or for "xy" the power of x; number_y: for "xy" the power of y.
frame: frame of the results: "lens", "axis" (that of the axis behind the last surface), or "film". With surface_count,
the frame of the last surface traced. rims: False if clear semi-diameters block no rays.
Returns status (N,); origin, optical direction and optical path (N, 7); their derivatives by the variables (N, 7, V),
and by the input origins and directions (N, 7, 6). NaN if status is not OK.)")
        .def("_backpropagate_rays", &backpropagate_rays, "origins_mm"_a, "directions"_a, "variables"_a, "of_origins"_a,
             "of_directions"_a, "of_optical_paths"_a, py::kw_only(), "wavelength_nm"_a = py::none(), "start"_a = "film",
             "Internal: use realcam.backpropagate_rays. Returns the derivatives of a function by the variables (V,), "
             "and "
             "by the origins and the directions (N, 3).");
}

}  // namespace realcam::bindings
