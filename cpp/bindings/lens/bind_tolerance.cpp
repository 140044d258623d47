// Monte Carlo tolerance evaluation, for realcam.tolerance.

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "../../embree/lens_rays.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/tolerance/perturbation.hpp"
#include "../../optics/tolerance/tolerance_evaluator.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Names of manufacturing errors, in the order of PerturbationKind.
constexpr std::array<std::string_view, 16> kKinds = {
    "radius",         "radius_percent", "radius_fringes",     "thickness",          "index",
    "abbe_percent",   "surface_tilt_x", "surface_tilt_y",     "surface_decentre_x", "surface_decentre_y",
    "element_tilt_x", "element_tilt_y", "element_decentre_x", "element_decentre_y", "irregularity_0",
    "irregularity_45"};

/// Manufacturing errors as tuples (kind, first, last): indices of the affected surfaces, from 0.
using ErrorNames = std::vector<std::tuple<std::string, int, int>>;

std::vector<Perturbation> perturbations_from(const ErrorNames& names) {
    std::vector<Perturbation> perturbations;
    for (const auto& [name, first, last] : names) {
        const auto* const kind = std::find(kKinds.begin(), kKinds.end(), name);
        if (kind == kKinds.end()) throw InputError("unknown kind of error \"" + name + "\"");
        perturbations.push_back({static_cast<PerturbationKind>(kind - kKinds.begin()), first, last});
    }
    return perturbations;
}

using Numbers = InputArray<double>;

/// `fields_rad`: (F, 2); `colours`: (C, 2) of (wavelength_nm, weight); `sharp_at`: Compensators::frequency; `shift`:
/// members of ElementShift.
ToleranceEvaluator make_evaluator(const LensSystem& lens, const Numbers& fields_rad,
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

/// Throws InputError unless the array has this number of dimensions and its last one the length `error_count`.
void check_sizes(const Numbers& sizes, int dimensions, std::size_t error_count) {
    if (sizes.ndim() != dimensions || sizes.shape(dimensions - 1) != static_cast<py::ssize_t>(error_count))
        throw InputError("expected one size for each of the " + std::to_string(error_count) + " errors");
}

/// Evaluates copies of the lens. `sizes`: (copies, errors). Returns arrays whose first dimension is the copies; see the
/// docstring.
Typed<"dict[str, NDArray[float64]]", py::dict> evaluate(const ToleranceEvaluator& evaluator, const ErrorNames& names,
                                                        const Numbers& sizes) {
    const std::vector<Perturbation> perturbations = perturbations_from(names);
    check_sizes(sizes, 2, perturbations.size());
    const auto count = static_cast<std::size_t>(sizes.shape(0));
    const std::span<const double> rows(sizes.data(), static_cast<std::size_t>(sizes.size()));
    std::vector<CopyFigures> copies(count);
    {
        const Unlocked unlocked;
        // One item per task, because evaluating a perturbed lens takes milliseconds; the results do not depend on the
        // number of threads.
        parallel_ray_loop(heed_signals, 1).for_all(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                copies[i] = evaluator(perturbed(evaluator.nominal(), perturbations,
                                                rows.subspan(i * perturbations.size(), perturbations.size())));
        });
    }
    const std::size_t fields = evaluator.request().fields.size(), frequencies = evaluator.request().frequencies.size();
    const auto by_copy = [&](auto&& f) { return array_of(count, [&](auto i) { return f(copies[i]); }); };
    const auto by_copy_and_field = [&](auto&& f) {
        return table_of(count, fields, [&](auto i, auto k) { return f(copies[i].fields[k]); });
    };
    const auto shape = [](auto... n) { return std::vector<py::ssize_t>{static_cast<py::ssize_t>(n)...}; };
    py::array_t<double> mtf(shape(count, fields, 2, frequencies)), chief_rays(shape(count, fields, 2));
    double *to_mtf = mtf.mutable_data(), *to_chief_rays = chief_rays.mutable_data();
    for (const CopyFigures& copy : copies)
        for (const FieldFigures& field : copy.fields) {
            to_mtf = std::copy(field.mtf.begin(), field.mtf.end(), to_mtf);
            *to_chief_rays++ = field.at.x;
            *to_chief_rays++ = field.at.y;
        }
    return py::dict(
        "focal_length_mm"_a = by_copy([](const CopyFigures& c) { return c.focal_length; }),
        "film_shift_mm"_a = by_copy([](const CopyFigures& c) { return c.settings.film_shift; }),
        "film_slope"_a = table_of(
            count, 2,
            [&](auto i, auto k) { return k == 0 ? copies[i].settings.film_slope.x : copies[i].settings.film_slope.y; }),
        "element_shift_mm"_a = table_of(count, 3,
                                        [&](auto i, auto k) {
                                            const Vec3d& shift = copies[i].settings.element_shift;
                                            return k == 0 ? shift.x : k == 1 ? shift.y : shift.z;
                                        }),
        "rms_spot_mm"_a = by_copy_and_field([](const FieldFigures& f) { return f.rms_spot; }),
        "distortion"_a = by_copy_and_field([](const FieldFigures& f) { return f.distortion; }),
        "light"_a = by_copy_and_field([](const FieldFigures& f) { return f.light; }), "chief_ray_mm"_a = chief_rays,
        "mtf"_a = mtf);
}

/// Returns a copy of the lens with errors and with the compensators at these settings (see CopySettings; lengths in
/// mm). Throws LensFileError if it is invalid.
LensSystem make_copy(const ToleranceEvaluator& evaluator, const ErrorNames& names, const Numbers& sizes,
                     double film_shift, std::pair<double, double> film_slope,
                     std::tuple<double, double, double> element_shift) {
    const std::vector<Perturbation> perturbations = perturbations_from(names);
    check_sizes(sizes, 1, perturbations.size());
    const auto& [x, y, z] = element_shift;
    const CopySettings settings{film_shift, {film_slope.first, film_slope.second}, {x, y, z}};
    LensSystem copy = with_settings(
        perturbed(evaluator.nominal(), perturbations, {sizes.data(), static_cast<std::size_t>(sizes.size())}), settings,
        evaluator.request().compensators);
    validate_with_film(copy);
    return copy;
}

}  // namespace

void bind_tolerance(py::module_& m) {
    py::class_<ToleranceEvaluator>(m, "_ToleranceEvaluator",
                                   "Internal: use realcam.tolerance. Evaluates copies of a lens with manufacturing "
                                   "errors.")
        .def(py::init(&make_evaluator), "lens"_a, "fields_rad"_a, "object_distance_m"_a, "colours"_a, "frequencies"_a,
             "rings"_a, "refocus"_a, "film_tilt"_a, "sharp_at"_a, "shift"_a,
             R"(fields_rad: (F, 2), directions whose length is the angle. colours: (C, 2) of (wavelength_nm, weight).
frequencies: of the MTF, periods per mm. rings: rings of rays in the stop. Compensators: refocus, film_tilt, and shift,
(first surface, last surface, along the axis, range in mm). sharp_at: frequency in periods per mm at which the
compensators maximise contrast; None: they minimise the mean square spot radius.)")
        .def("judge", &evaluate, "errors"_a, "sizes"_a,
             R"(Evaluates N copies. errors: (kind, first, last) for each error; sizes: (N, errors). Returns arrays of
shape (N, ...): focal_length_mm, settings of the compensators, and by field F rms_spot_mm, distortion, light (unblocked
fraction of the stop), chief_ray_mm (N, F, 2), and mtf (N, F, 2, frequencies), along and across the field.)")
        .def("copy", &make_copy, "errors"_a, "sizes"_a, "film_shift_mm"_a, "film_slope"_a, "element_shift_mm"_a,
             "Returns the Lens with errors of these sizes, (errors,), and with these settings of the compensators.");
}

}  // namespace realcam::bindings
