// Analyses of one object point by rays aimed at the stop: Lens.aim, Lens.wavefront and Lens.spot.

#include <pybind11/stl.h>

#include "../../embree/lens_rays.hpp"
#include "../../optics/analysis/ray_aiming.hpp"
#include "../../optics/analysis/spot.hpp"
#include "../../optics/analysis/wavefront.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/restored.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "analysis_arguments.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Array = py::array_t<double>;
using Points = InputArray<double>;

/// Returns the distance from the last vertex to the image plane, mm: that of the lens's film for std::nullopt. Throws
/// InputError.
double film_distance_from(const LensSystem& lens, std::optional<double> mm) {
    if (mm && !std::isfinite(*mm)) throw InputError("film_distance_mm must be a finite length, or None for the film");
    return mm.value_or(lens.film_distance);
}

Array pupil_of(const FieldRays& rays) {
    return table_of(rays.pattern.size(), 2,
                    [&](auto i, auto k) { return k == 0 ? rays.pattern[i].x : rays.pattern[i].y; });
}

Array weights_of(const FieldRays& rays) {
    double sum = 0;
    for (const PupilPoint& point : rays.pattern) sum += point.weight;
    return array_of(rays.pattern.size(), [&](auto i) { return rays.pattern[i].weight / sum; });
}

py::array_t<int> status_of(const FieldRays& rays) {
    return array_of<int>(rays.rays.size(), [&](auto i) { return static_cast<int>(rays.rays[i].status); });
}

constexpr const char* kPupilText =
    "(N, 2): points (x, y) on the aperture stop, in units of the radius of the stop's bounding circle.";
constexpr const char* kWeightsText =
    "(N,): fraction of the area of the stop's bounding circle that each ray represents; the sum is 1.";
constexpr const char* kStatusText =
    "(N,): RayStatus values; NO_CONVERGENCE if no ray was found that hits the point of the stop.";

/// Rays in front of the lens, see the docstrings of the Python class.
struct AimedRays {
    Array origins_mm, directions;
    py::array_t<int> status;
};

AimedRays aim(const LensSystem& lens, const Points& pupil, double field_deg, std::optional<double> object_distance_m,
              const FilmPoint& film_mm, std::optional<double> wavelength_nm) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    const std::vector<PupilPoint> pattern = pattern_from("", 1, pupil);
    const RayAimer aimer(lens, wavelength, field_from(field_deg, object_distance_m, film_mm));
    const auto count = static_cast<py::ssize_t>(pattern.size());
    AimedRays aimed{Array({count, py::ssize_t{3}}), Array({count, py::ssize_t{3}}), py::array_t<int>(count)};
    double* origins = aimed.origins_mm.mutable_data();
    double* directions = aimed.directions.mutable_data();
    int* status = aimed.status.mutable_data();
    {
        const Unlocked unlocked;
        const RayLoop loop = parallel_ray_loop(heed_signals);
        const std::vector<AimedRay> rays = aim_all(aimer, pattern, stop_bounding_radius(lens), loop);
        loop.for_all(rays.size(), [&](std::size_t first, std::size_t last) {
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            const auto write = [](Vec3d v, double* to) { to[0] = v.x, to[1] = v.y, to[2] = v.z; };
            for (std::size_t i = first; i < last; ++i) {
                const bool passes = rays[i].status == RayStatus::ok;
                write(passes ? aimer.in_lens_frame(aimer.object.at(rays[i].entry)) : Vec3d{kNone, kNone, kNone},
                      origins + 3 * i);
                write(passes ? aimer.object.direction(rays[i].entry) : Vec3d{kNone, kNone, kNone}, directions + 3 * i);
                status[i] = static_cast<int>(rays[i].status);
            }
        });
    }
    return aimed;
}

/// Wavefront with the data that its Python class shows. `last_vertex_mm`: z of the last vertex from the front vertex.
struct PythonWavefront {
    Wavefront wavefront;
    double wavelength_nm, stop_radius_mm, last_vertex_mm;
    int columns;  ///< side of the grid of samples; 0 for other patterns
};

PythonWavefront make_wavefront(const LensSystem& lens, double field_deg, std::optional<double> object_distance_m,
                               const FilmPoint& film_mm, std::optional<double> wavelength_nm,
                               std::optional<double> film_distance_mm, const std::string& reference,
                               const std::string& exit_pupil, const std::optional<std::string>& remove,
                               const std::string& pattern, int samples, const std::optional<Points>& pupil) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    const double distance = film_distance_from(lens, film_distance_mm);
    const FieldPoint field = field_from(field_deg, object_distance_m, film_mm);
    std::vector<PupilPoint> points = pattern_from(pattern, samples, pupil);
    if (reference != "chief" && reference != "centroid")
        throw InputError("unknown reference \"" + reference + "\"; expected chief or centroid");
    if (exit_pupil != "real" && exit_pupil != "paraxial")
        throw InputError("unknown exit_pupil \"" + exit_pupil + "\"; expected real or paraxial");
    if (remove && *remove != "tilt" && *remove != "focus")
        throw InputError("cannot remove \"" + *remove + "\"; expected tilt, focus or None");
    const Unlocked unlocked;
    const RayLoop loop = parallel_ray_loop(heed_signals);
    return {wavefront_of(lens, wavelength, field_rays(lens, wavelength, field, std::move(points), loop), distance,
                         reference == "chief" ? SphereCentre::chief : SphereCentre::centroid,
                         !remove             ? Removed::nothing
                         : *remove == "tilt" ? Removed::tilt
                                             : Removed::focus,
                         exit_pupil == "real" ? ExitPupil::real : ExitPupil::paraxial, loop),
            wavelength, stop_bounding_radius(lens), lens.last_vertex(), pattern == "grid" && !pupil ? samples : 0};
}

/// Returns the OPD in waves as an array of shape (columns, columns).
Array opd_map(const PythonWavefront& w) {
    if (w.columns == 0) throw InputError("a map requires the pattern \"grid\"");
    const auto n = static_cast<std::size_t>(w.columns);
    Array map = table_of(n, n, [](auto, auto) { return std::numeric_limits<double>::quiet_NaN(); });
    for (std::size_t i = 0; i < w.wavefront.opd.size(); ++i)
        map.mutable_data()[w.wavefront.rays.pattern[i].cell] = w.wavefront.opd[i];
    return map;
}

Spot make_spot(const LensSystem& lens, double field_deg, std::optional<double> object_distance_m,
               const FilmPoint& film_mm, std::optional<double> wavelength_nm, std::optional<double> film_distance_mm,
               const std::string& pattern, int samples, const std::optional<Points>& pupil) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    const double distance = film_distance_from(lens, film_distance_mm);
    std::vector<PupilPoint> points = pattern_from(pattern, samples, pupil);
    const Unlocked unlocked;
    const RayLoop loop = parallel_ray_loop(heed_signals);
    const FieldPoint field = field_from(field_deg, object_distance_m, film_mm);
    return spot_of(field_rays(lens, wavelength, field, std::move(points), loop), distance, loop);
}

using PythonLens = py::class_<LensSystem>;

/// Defines the properties of a result that describe its rays.
template <class T, class RaysOf>
void def_rays(py::class_<T>& type, const RaysOf& rays_of) {
    type.def_property_readonly(
            "pupil", [=](const T& t) { return pupil_of(rays_of(t)); }, kPupilText)
        .def_property_readonly(
            "weights", [=](const T& t) { return weights_of(rays_of(t)); }, kWeightsText)
        .def_property_readonly("status", [=](const T& t) { return status_of(rays_of(t)); }, kStatusText);
}

void bind_aim(py::module_& m, PythonLens& lens) {
    py::class_<AimedRays> aimed_rays(m, "AimedRays",
                                     "Rays of one object point in front of the lens, in the lens frame. See Lens.aim.");
    def_result(aimed_rays, [](const AimedRays& aimed) {
        const py::ssize_t count = length_of(aimed.status);
        check_arrays('f', {count, 3}, {aimed.origins_mm, aimed.directions});
        check_arrays('i', {count}, {aimed.status});
    });
    aimed_rays
        .def_readonly(
            "origins_mm", &AimedRays::origins_mm,
            R"((N, 3): intersections of the rays with the plane through the centre of the paraxial entrance pupil,
perpendicular to the light. It may lie behind the front surface; the ray is the whole straight line. If film_mm
specifies the field, or the lens is not rotationally symmetric, the plane goes through the chief ray's
intersection with the front surface. nan if status is not OK.)")
        .def_readonly("directions", &AimedRays::directions,
                      "(N, 3): unit vectors in the direction of the light; nan if status is not OK.")
        .def_readonly("status", &AimedRays::status, kStatusText)
        .def("__repr__",
             [](const AimedRays& rays) { return "<realcam.AimedRays " + counted(py::len(rays.status), "ray") + '>'; });
    static const std::string aim_text =
        std::string(
            R"(Finds the rays of one object point that hit specified points of the real stop, for
Lens.trace(start="scene").
pupil: (N, 2), points of the stop in units of its radius.
)") + kFieldText +
        R"(Returns AimedRays. The status is that of the ray behind the lens; a ray whose status is not OK is nan.
Origins may lie behind the front surface, because Lens.trace uses the whole straight line of a ray. For points on the
edge of the stop the aim is 5e-11 of its radius further inside, so that rounding does not block the ray when it is
traced.
Raises InputError if no ray of the object point reaches the centre of the stop.)";
    lens.def("aim", &aim, "pupil"_a, "field_deg"_a = 0.0, py::kw_only(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(), aim_text.c_str());
}

void bind_wavefront(py::module_& m, PythonLens& lens) {
    using W = const PythonWavefront&;
    py::class_<PythonWavefront> wavefront(
        m, "Wavefront",
        R"(Optical path differences (OPD) of one object point over the stop, in waves; positive where the wavefront is
ahead of the reference sphere. Means are over the area of the open stop. See Lens.wavefront.)");
    def_value(wavefront, [](W w) {
        const std::vector<PupilPoint>& pattern = w.wavefront.rays.pattern;
        require_restored(w.wavefront.rays.rays.size() == pattern.size() && w.wavefront.opd.size() == pattern.size());
        require_restored(w.columns >= 0 && w.columns <= kMaxPatternSamples);
        for (const PupilPoint& point : pattern)
            require_restored(w.columns == 0 || (point.cell >= 0 && point.cell < w.columns * w.columns));
    });
    def_rays(wavefront, [](W w) -> const FieldRays& { return w.wavefront.rays; });
    wavefront
        .def_property_readonly(
            "opd_waves",
            [](W w) { return array_of(w.wavefront.opd.size(), [&](auto i) { return w.wavefront.opd[i]; }); },
            "(N,): OPD of each ray, relative to the chief ray if remove is None; nan if the ray does not pass.")
        .def("map_waves", &opd_map,
             R"(Returns opd_waves of the pattern "grid" as an array of shape (samples, samples), rows from the lowest y,
columns from the lowest x; nan where no ray passes. Raises InputError for other patterns.)")
        .def_property_readonly(
            "rms_waves", [](W w) { return w.wavefront.rms; }, "RMS of the OPD about its mean, in waves.")
        .def_property_readonly(
            "peak_to_valley_waves", [](W w) { return w.wavefront.peak_to_valley; },
            "Largest minus smallest OPD, in waves.")
        .def_property_readonly(
            "strehl", [](W w) { return w.wavefront.strehl; }, "Strehl ratio |mean of exp(2 pi i OPD)|^2.")
        .def_property_readonly(
            "strehl_marechal", [](W w) { return w.wavefront.strehl_marechal; },
            "Strehl ratio by Marechal's approximation in Mahajan's form, exp(-(2 pi rms_waves)^2).")
        .def_property_readonly(
            "centre_mm",
            [](W w) {
                const Vec3d c = w.wavefront.centre;
                return std::array{c.x, c.y, c.z + w.last_vertex_mm};
            },
            "(x, y, z) of the reference sphere's centre in mm, lens frame.")
        .def_property_readonly(
            "reference_radius_mm", [](W w) { return 1 / w.wavefront.reference_curvature; },
            "Radius of the reference sphere; positive if the light travels from the exit pupil to the "
            "sphere's centre, inf for a plane.")
        .def_readonly("stop_radius_mm", &PythonWavefront::stop_radius_mm,
                      "Radius of the stop's bounding circle, the unit of pupil.")
        .def_readonly("wavelength_nm", &PythonWavefront::wavelength_nm, "Wavelength.")
        .def("__repr__", [](W w) {
            return "<realcam.Wavefront " + counted(w.wavefront.opd.size(), "ray") + ", RMS " + digits(w.wavefront.rms) +
                   " waves, Strehl " + digits(w.wavefront.strehl) + '>';
        });
    static const std::string wavefront_text =
        std::string(
            R"(Computes the wavefront of one object point relative to a reference sphere, by real rays, in double
precision.
)") + kFieldText +
        R"(film_distance_mm: distance from the last vertex to the plane of the image point; None: the film.
reference: centre of the reference sphere. "chief": intersection of the chief ray (through the centre of the real stop)
  with that plane; "centroid": centroid of the spot there. The sphere's radius is the distance along the chief ray from
  its intersection to the exit pupil.
exit_pupil: position of the exit pupil on the chief ray. "real": intersection with the axis (for a field on the axis,
  the paraxial exit pupil), as in CODE V's listings; "paraxial": intersection with the plane of the paraxial exit
  pupil, as in OpticStudio.
remove: terms that are fitted over the stop and subtracted. None: no terms; "tilt": x and y; "focus": x, y and
  x^2 + y^2.
)" + kPatternText +
        "Returns a Wavefront. Raises InputError if no ray passes, or no reference sphere exists.";
    lens.def("wavefront", &make_wavefront, "field_deg"_a = 0.0, py::kw_only(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(), "film_distance_mm"_a = py::none(),
             "reference"_a = "chief", "exit_pupil"_a = "real", "remove"_a = py::none(), "pattern"_a = "grid",
             "samples"_a = 64, "pupil"_a = py::none(), wavefront_text.c_str());
}

void bind_spot(py::module_& m, PythonLens& lens) {
    py::class_<Spot> spot(
        m, "Spot",
        R"(Spot diagram: intersections of the rays of one object point with a plane behind the lens, in
mm from the axis. See Lens.spot.)");
    def_value(spot, [](const Spot& s) {
        require_restored(s.rays.rays.size() == s.rays.pattern.size() && s.points.size() == s.rays.pattern.size());
    });
    def_rays(spot, [](const Spot& s) -> const FieldRays& { return s.rays; });
    spot.def_property_readonly(
            "points_mm",
            [](const Spot& s) {
                return table_of(s.points.size(), 2,
                                [&](auto i, auto k) { return k == 0 ? s.points[i].x : s.points[i].y; });
            },
            "(N, 2): intersection (x, y) of each ray; nan if the ray does not pass.")
        .def_property_readonly(
            "directions",
            [](const Spot& s) {
                constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
                return table_of(s.points.size(), 3, [&](auto i, auto k) {
                    const Vec3d d = normalized(s.rays.rays[i].direction);
                    return !s.rays.passes(i) ? kNone : k == 0 ? d.x : k == 1 ? d.y : d.z;
                });
            },
            "(N, 3): unit direction of each ray behind the lens; nan if the ray does not pass.")
        .def_property_readonly(
            "centroid_mm", [](const Spot& s) { return std::pair(s.centroid.x, s.centroid.y); },
            "(x, y) of the weighted mean of the intersections.")
        .def_property_readonly(
            "chief_ray_mm", [](const Spot& s) { return std::pair(s.chief.x, s.chief.y); },
            "(x, y) of the ray through the centre of the stop, even if the lens blocks it.")
        .def_property_readonly(
            "rms_radius_mm", [](const Spot& s) { return s.about_centroid.rms_radius; },
            "RMS distance of the intersections from the centroid.")
        .def_property_readonly(
            "max_radius_mm", [](const Spot& s) { return s.about_centroid.max_radius; },
            "Largest distance of an intersection from the centroid.")
        .def_property_readonly(
            "rms_radius_about_chief_ray_mm", [](const Spot& s) { return s.about_chief.rms_radius; },
            "RMS distance of the intersections from that of the chief ray.")
        .def_property_readonly(
            "max_radius_about_chief_ray_mm", [](const Spot& s) { return s.about_chief.max_radius; },
            "Largest distance of an intersection from that of the chief ray.")
        .def("__repr__", [](const Spot& s) {
            return "<realcam.Spot " + counted(s.points.size(), "ray") + ", RMS radius " +
                   digits(s.about_centroid.rms_radius) + " mm>";
        });

    static const std::string spot_text = std::string(
                                             R"(Computes the spot diagram of one object point by real rays.
)") + kFieldText + "film_distance_mm: distance from the last vertex to the plane of the spot; None: the film.\n" +
                                         kPatternText + "Returns a Spot. Raises InputError if no ray passes.";
    lens.def("spot", &make_spot, "field_deg"_a = 0.0, py::kw_only(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(), "film_distance_mm"_a = py::none(),
             "pattern"_a = "hexapolar", "samples"_a = 6, "pupil"_a = py::none(), spot_text.c_str());
}

}  // namespace

void bind_analysis(py::module_& m) {
    auto lens = py::reinterpret_borrow<PythonLens>(m.attr("Lens"));
    bind_aim(m, lens);
    bind_wavefront(m, lens);
    bind_spot(m, lens);
}

}  // namespace realcam::bindings
