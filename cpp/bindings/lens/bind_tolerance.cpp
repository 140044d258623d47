#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "../../embree/lens_rays.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/tolerance/lens_error.hpp"
#include "../../optics/tolerance/tolerance_evaluator.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Names in the order of ErrorKind.
constexpr std::array<std::string_view, 16> kKinds = {
    "radius",         "radius_percent", "radius_fringes",     "thickness",          "index",
    "abbe_percent",   "surface_tilt_x", "surface_tilt_y",     "surface_decentre_x", "surface_decentre_y",
    "element_tilt_x", "element_tilt_y", "element_decentre_x", "element_decentre_y", "irregularity_0",
    "irregularity_45"};

using ErrorNames = std::vector<std::tuple<std::string, int, int>>;

std::vector<LensError> errors_from(const ErrorNames& names) {
    std::vector<LensError> errors;
    for (const auto& [name, first, last] : names) {
        const auto* const kind = std::find(kKinds.begin(), kKinds.end(), name);
        if (kind == kKinds.end()) throw InputError("unknown kind of error \"" + name + "\"");
        errors.push_back({static_cast<ErrorKind>(kind - kKinds.begin()), first, last});
    }
    return errors;
}

using Numbers = InputArray<double>;

ToleranceEvaluator make_judge(const LensSystem& lens, const Numbers& fields_rad,
                              std::optional<double> object_distance_m, const Numbers& colours,
                              std::vector<double> frequencies, int rings, bool refocus, bool film_tilt,
                              std::optional<double> sharp_at,
                              const std::optional<std::tuple<int, int, bool, double>>& shift) {
    StudyRequest request;
    for (py::ssize_t i = 0; i < fields_rad.shape(0); ++i)
        request.fields.push_back({fields_rad.at(i, 0), fields_rad.at(i, 1)});
    for (py::ssize_t i = 0; i < colours.shape(0); ++i) request.colours.push_back({colours.at(i, 0), colours.at(i, 1)});
    if (object_distance_m) request.object_distance = 1000 * *object_distance_m;
    request.frequencies = std::move(frequencies);
    request.rings = rings;
    request.compensators = {sharp_at, refocus, film_tilt, std::nullopt};
    if (shift) {
        const auto& [first, last, along_axis, range] = *shift;
        request.compensators.shift = ElementShift{first, last, along_axis, range};
    }
    const Unlocked unlocked;
    return ToleranceEvaluator(lens, std::move(request), parallel_ray_loop(heed_signals));
}

void check_sizes(const Numbers& sizes, int dimension, std::size_t errors) {
    if (sizes.ndim() != dimension || sizes.shape(dimension - 1) != static_cast<py::ssize_t>(errors))
        throw InputError("as many sizes as errors are wanted, " + std::to_string(errors));
}

Typed<"dict[str, NDArray[float64]]", py::dict> judge(const ToleranceEvaluator& judge, const ErrorNames& names,
                                                     const Numbers& sizes) {
    const std::vector<LensError> errors = errors_from(names);
    check_sizes(sizes, 2, errors.size());
    const auto count = static_cast<std::size_t>(sizes.shape(0));
    const double* rows = sizes.data();
    std::vector<CopyFigures> found(count);
    {
        const Unlocked unlocked;
        // One item per task, because evaluating a perturbed lens takes milliseconds; the results do not depend on the
        // number of threads.
        parallel_ray_loop(heed_signals, 1).for_all(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                found[i] = judge(with_errors(judge.nominal(), errors, rows + i * errors.size()));
        });
    }
    const std::size_t fields = judge.request().fields.size(), frequencies = judge.request().frequencies.size();
    const auto of_copies = [&](auto&& f) { return array_of(count, [&](auto i) { return f(found[i]); }); };
    const auto of_fields = [&](auto&& f) {
        return table_of(count, fields, [&](auto i, auto k) { return f(found[i].fields[k]); });
    };
    const auto shape = [](auto... n) { return std::vector<py::ssize_t>{static_cast<py::ssize_t>(n)...}; };
    py::array_t<double> mtf(shape(count, fields, 2, frequencies)), at(shape(count, fields, 2));
    double *to_mtf = mtf.mutable_data(), *to_at = at.mutable_data();
    for (const CopyFigures& copy : found)
        for (const FieldFigures& field : copy.fields) {
            to_mtf = std::copy(field.mtf.begin(), field.mtf.end(), to_mtf);
            *to_at++ = field.at.x;
            *to_at++ = field.at.y;
        }
    return py::dict(
        "focal_length_mm"_a = of_copies([](const CopyFigures& c) { return c.focal_length; }),
        "film_shift_mm"_a = of_copies([](const CopyFigures& c) { return c.settings.film_shift; }),
        "film_slope"_a = table_of(
            count, 2,
            [&](auto i, auto k) { return k == 0 ? found[i].settings.film_slope.x : found[i].settings.film_slope.y; }),
        "element_shift_mm"_a = table_of(count, 3,
                                        [&](auto i, auto k) {
                                            const Vec3d& shift = found[i].settings.element_shift;
                                            return k == 0 ? shift.x : k == 1 ? shift.y : shift.z;
                                        }),
        "rms_spot_mm"_a = of_fields([](const FieldFigures& f) { return f.rms_spot; }),
        "distortion"_a = of_fields([](const FieldFigures& f) { return f.distortion; }),
        "light"_a = of_fields([](const FieldFigures& f) { return f.light; }), "chief_ray_mm"_a = at, "mtf"_a = mtf);
}

LensSystem make_copy(const ToleranceEvaluator& judge, const ErrorNames& names, const Numbers& sizes, double film_shift,
                     std::pair<double, double> film_slope, std::tuple<double, double, double> element_shift) {
    const std::vector<LensError> errors = errors_from(names);
    check_sizes(sizes, 1, errors.size());
    const auto& [x, y, z] = element_shift;
    const CopySettings settings{film_shift, {film_slope.first, film_slope.second}, {x, y, z}};
    LensSystem copy =
        with_settings(with_errors(judge.nominal(), errors, sizes.data()), settings, judge.request().compensators);
    validate(copy);
    if (const std::string why = film_distance_error(copy); !why.empty()) throw LensFileError(why);
    return copy;
}

}  // namespace

void bind_tolerance(py::module_& m) {
    py::class_<ToleranceEvaluator>(m, "_ToleranceEvaluator")
        .def(py::init(&make_judge), "lens"_a, "fields_rad"_a, "object_distance_m"_a, "colours"_a, "frequencies"_a,
             "rings"_a, "refocus"_a, "film_tilt"_a, "sharp_at"_a, "shift"_a)
        .def("judge", &judge, "errors"_a, "sizes"_a)
        .def("copy", &make_copy, "errors"_a, "sizes"_a, "film_shift_mm"_a, "film_slope"_a, "element_shift_mm"_a);
}

}  // namespace realcam::bindings
