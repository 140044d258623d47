#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "../../embree/lens_rays.hpp"
#include "../../optics/derivatives/adjoint_path.hpp"
#include "../../optics/derivatives/dual_path.hpp"
#include "../../optics/trace/trace_request.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Variables = std::vector<std::tuple<std::string, int, int, int>>;

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

std::vector<LensVariable> variables_from(const Variables& variables) {
    std::vector<LensVariable> list;
    for (const auto& [name, surface, number, number_y] : variables) {
        const auto is_it = [&](const FormWords& words) { return name == words.key; };
        const auto row = std::find_if(kFormWords.begin(), kFormWords.end(), is_it);
        if (row != kFormWords.end()) {
            const auto index = static_cast<int>(row - kFormWords.begin());
            list.push_back({LensQuantity::terms, surface, number, number_y, index});
            continue;
        }
        const auto found = quantities().find(name);
        if (found == quantities().end()) {
            std::string all;
            for (const auto& [known, quantity] : quantities()) all += known + ", ";
            for (const FormWords& words : kFormWords) all += words.key + std::string(", ");
            throw InputError("unknown quantity \"" + name + "\"; one of " + all.substr(0, all.size() - 2) +
                             " is wanted");
        }
        list.push_back({found->second, surface, number, number_y});
    }
    return list;
}

/// Writes the derivatives with respect to the caller's origin and direction, given those with respect to a start point
/// on the same line and an optical direction (index times unit direction).
void write_by_ray(const RayDerivatives& ray, Vec3d given, const LensEntry& entry, double index, Vec3d from,
                  double* out) {
    const double size = length(given);
    const Vec3d unit = (1 / size) * given;
    const double distance = dot(entry.origin - from, unit) / size;  // entry.origin = from + distance given
    for (int row = 0; row < RayDerivatives::kNumbers; ++row) {
        const double* by = ray.by_start[row];
        const Vec3d by_origin{by[0], by[1], by[2]}, by_optical{by[3], by[4], by[5]};
        Vec3d by_direction = (index / size) * (by_optical - dot(by_optical, unit) * unit) + distance * by_origin;
        if (row == 6) by_direction = by_direction + index * distance * unit;
        const double numbers[6] = {by_origin.x,    by_origin.y,    by_origin.z,
                                   by_direction.x, by_direction.y, by_direction.z};
        std::copy(numbers, numbers + 6, out + 6 * row);
    }
}

py::ssize_t differentiated_rays(const InputArray<double>& origins, const InputArray<double>& directions) {
    const bool fits = origins.ndim() == 2 && origins.shape(1) == 3 && directions.ndim() == 2 &&
                      directions.shape(1) == 3 && origins.shape(0) == directions.shape(0);
    if (!fits) throw InputError("origins_mm and directions must both be arrays of shape (N, 3)");
    return origins.shape(0);
}

LightDirection direction_of_derivatives(const std::string& start) {
    if (start != "film" && start != "scene") throw InputError("start must be \"film\" or \"scene\"");
    return start == "film" ? LightDirection::to_scene : LightDirection::to_film;
}

Typed<"tuple[NDArray[float64], NDArray[float64], NDArray[float64]]", py::tuple> backpropagate_rays(
    const LensSystem& lens, const InputArray<double>& origins, const InputArray<double>& directions,
    const Variables& variables, const InputArray<double>& of_origins, const InputArray<double>& of_directions,
    const InputArray<double>& of_paths, std::optional<double> wavelength_nm, const std::string& start) {
    const py::ssize_t count = differentiated_rays(origins, directions);
    for (const InputArray<double>* of : {&of_origins, &of_directions})
        if (of->ndim() != 2 || of->shape(0) != count || of->shape(1) != 3)
            throw InputError("of_origins and of_directions must be arrays of shape (N, 3), as the rays are");
    if (of_paths.ndim() != 1 || of_paths.shape(0) != count)
        throw InputError("of_optical_paths must be an array of shape (N,), one number for each ray");
    const AdjointPath path(lens, direction_of_derivatives(start), wavelength_or_design(lens, wavelength_nm),
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
    const std::vector<double> by = [&] {
        const Unlocked unlocked;
        return path.gradient(request, parallel_ray_loop(heed_signals, 1));
    }();
    return py::make_tuple(py::array_t<double>(static_cast<py::ssize_t>(by.size()), by.data()), by_origins,
                          by_directions);
}

Typed<"tuple[NDArray[int32], NDArray[float64], NDArray[float64], NDArray[float64]]", py::tuple> ray_derivatives(
    const LensSystem& lens, const InputArray<double>& origins, const InputArray<double>& directions,
    const Variables& variables, std::optional<double> wavelength_nm, const std::string& start, const std::string& frame,
    std::optional<int> surface_count, bool rims) {
    const py::ssize_t count = differentiated_rays(origins, directions);
    const DualPath path(lens, direction_of_derivatives(start), wavelength_or_design(lens, wavelength_nm),
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
                    const Vec3d from{o[0], o[1], o[2] - path.entry_position()}, given{d[0], d[1], d[2]};
                    const LensEntry entry = enter_lens(from, given, path.entry_index(), path.entry_reach());
                    RayStatus end = entry.status;
                    if (end == RayStatus::ok) end = path.trace(entry.origin, entry.direction, tape, surfaces);
                    to_status[i] = static_cast<int>(end);
                    const std::size_t seven = kNumbers, many = seven * path.variable_count();
                    if (end != RayStatus::ok) {
                        std::fill_n(to_numbers + seven * i, seven, kNone);
                        std::fill_n(to_variables + many * i, many, kNone);
                        std::fill_n(to_ray + 6 * seven * i, 6 * seven, kNone);
                        continue;
                    }
                    if (surfaces == all)
                        path.derivatives(tape, ray);
                    else
                        path.derivatives_behind(tape, surfaces, ray);
                    const double seven_numbers[] = {ray.origin.x,
                                                    ray.origin.y,
                                                    ray.origin.z,
                                                    ray.direction.x,
                                                    ray.direction.y,
                                                    ray.direction.z,
                                                    ray.path + entry.optical_path};
                    std::copy(seven_numbers, seven_numbers + seven, to_numbers + seven * i);
                    double* row = to_variables + many * i;
                    for (std::size_t k = 0; k < seven; ++k)
                        for (std::size_t v = 0; v < many; v += seven) *row++ = ray.by_variable[v + k];
                    write_by_ray(ray, given, entry, path.entry_index(), from, to_ray + 6 * seven * i);
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
             R"(For realcam.derivatives, which says more. variables: tuples of a quantity, a surface from 0, and two
numbers. frame: "lens", "axis" for that of the axis behind the last surface, or "film". With surface_count the frame
of the last surface crossed. Returns status (N,); origin, optical direction and optical path (N, 7); their
derivatives by the variables (N, 7, V), and by the given origin and direction (N, 7, 6).)")
        .def("_backpropagate_rays", &backpropagate_rays, "origins_mm"_a, "directions"_a, "variables"_a, "of_origins"_a,
             "of_directions"_a, "of_optical_paths"_a, py::kw_only(), "wavelength_nm"_a = py::none(), "start"_a = "film",
             "For realcam.backpropagate_rays, which says more. Returns (V,), (N, 3), (N, 3).");
}

}  // namespace realcam::bindings
