// Ray bundles that fill what a lens transmits: Lens.bundle, Lens.film_points and Lens.film_pupil.

#include <pybind11/stl.h>

#include "../../embree/lens_rays.hpp"
#include "../../optics/analysis/film_bundle.hpp"
#include "../../optics/analysis/point_bundle.hpp"
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

constexpr int kSearchRays = 12;  ///< rays across the stop in the initial search for the transmitted light

/// Members of RayBundle that describe the chief ray; see the docstrings.
struct ChiefRay {
    std::array<double, 2> film_point_mm;
    double tangential_focus_mm, sagittal_focus_mm;
};

/// Ray bundle as Python exposes it; see the docstrings.
struct RayBundle {
    Array entry_mm, energy, points_mm, directions, slopes, path_mm, amplitude;
    Array edge_entry_mm, edge_slopes;
    ChiefRay chief_ray;
    double film_distance_mm, wavelength_nm, index;
    bool mirrored;
};

/// Returns an array (M, 2, 2) of the end points of the edge's segments: `end_point(segment, 0)` and
/// `end_point(segment, 1)`.
Array edge_array(const std::vector<EdgePiece>& edge, Vec2<double> (*end_point)(const EdgePiece&, std::size_t)) {
    Array array({static_cast<py::ssize_t>(edge.size()), py::ssize_t{2}, py::ssize_t{2}});
    double* to = array.mutable_data();
    for (const EdgePiece& piece : edge)
        for (std::size_t end = 0; end < 2; ++end) {
            const Vec2<double> point = end_point(piece, end);
            *to++ = point.x;
            *to++ = point.y;
        }
    return array;
}

RayBundle make_bundle(const LensSystem& lens, double field_deg, std::optional<double> object_distance_m,
                      const FilmPoint& film_mm, std::optional<double> wavelength_nm,
                      std::optional<double> film_distance_mm, int arms, int nodes) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    if (film_distance_mm && !std::isfinite(*film_distance_mm))
        throw InputError("film_distance_mm must be a finite length, or None for the film");
    if (!(arms >= 4 && arms <= 4096)) throw InputError("arms must lie between 4 and 4096");
    if (!(nodes >= 1 && nodes <= 256)) throw InputError("nodes must lie between 1 and 256");
    const double distance = film_distance_mm.value_or(lens.film_distance);
    const FieldPoint field = field_from(field_deg, object_distance_m, film_mm);
    const auto [bundle, traced] = [&] {
        const Unlocked unlocked;
        const RayLoop loop = parallel_ray_loop(heed_signals);
        PointBundle made(lens, wavelength, field, distance, loop, kSearchRays);
        TracedBundle rays = traced_bundle(made, {arms, nodes}, loop);
        return std::pair(std::move(made), std::move(rays));
    }();
    const std::vector<BundleRay>& rays = traced.rays;
    const auto pairs_of = [&](auto&& f) {
        return table_of(rays.size(), 2, [&](auto i, auto k) { return k == 0 ? f(rays[i]).x : f(rays[i]).y; });
    };
    const auto numbers_of = [&](auto&& f) { return array_of(rays.size(), [&](auto i) { return f(rays[i]); }); };
    const auto component = [](Vec3d v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; };
    const Vec2<double> chief = bundle.chief;
    return {
        pairs_of([](const BundleRay& ray) { return Vec2<double>{ray.entry.x, ray.entry.y}; }),
        numbers_of([](const BundleRay& ray) { return ray.energy; }),
        pairs_of([&](const BundleRay& ray) { return Vec2<double>{ray.at.x + chief.x, ray.at.y + chief.y}; }),
        table_of(rays.size(), 3, [&](auto i, auto k) { return component(rays[i].direction, k); }),
        pairs_of([](const BundleRay& ray) { return ray.wave.slope; }),
        numbers_of([](const BundleRay& ray) { return ray.wave.path; }),
        numbers_of([](const BundleRay& ray) { return ray.amplitude; }),
        edge_array(traced.edge, [](const EdgePiece& piece,
                                   std::size_t end) { return Vec2<double>{piece.entry[end].x, piece.entry[end].y}; }),
        edge_array(traced.edge, [](const EdgePiece& piece, std::size_t end) { return piece.slope[end]; }),
        {{chief.x, chief.y}, traced.tangential_focus, traced.sagittal_focus},
        distance,
        wavelength,
        bundle.index,
        bundle.mirrored};
}

/// Returns an array (M, 2) of float32: the film points of the rays that pass, out of `count` rays.
Typed<"NDArray[float32]", py::array> make_film_points(const LensSystem& lens, double field_deg, std::int64_t count,
                                                      std::optional<double> object_distance_m, const FilmPoint& film_mm,
                                                      std::optional<double> wavelength_nm,
                                                      std::optional<double> film_distance_mm,
                                                      const std::string& pattern, const DTypeLike& dtype) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    if (film_distance_mm && !std::isfinite(*film_distance_mm))
        throw InputError("film_distance_mm must be a finite length, or None for the film");
    if (!(count >= 1 && count <= (std::int64_t{1} << 31))) throw InputError("count must lie between 1 and 2147483648");
    if (pattern != "even" && pattern != "grid")
        throw InputError("unknown pattern \"" + pattern + "\"; expected even or grid");
    const py::dtype type = py::dtype::from_args(dtype);
    if (type.kind() != 'f' || (type.itemsize() != 4 && type.itemsize() != 8))
        throw InputError("dtype must be \"float64\" or \"float32\"");
    const FieldPoint field = field_from(field_deg, object_distance_m, film_mm);
    const double distance = film_distance_mm.value_or(lens.film_distance);
    py::array_t<float> points({static_cast<py::ssize_t>(count), py::ssize_t{2}});
    float* to = points.mutable_data();
    const std::int64_t passed = [&] {
        const Unlocked unlocked;
        const PointBundle bundle(lens, wavelength, field, distance, parallel_ray_loop(heed_signals), kSearchRays);
        return find_film_points(lens, wavelength, bundle, pattern == "even" ? EntryPattern::even : EntryPattern::grid,
                                type.itemsize() == 8 ? Precision::float64 : Precision::float32, count, bundle.plane(),
                                to, heed_signals);
    }();
    return points[py::slice(0, static_cast<py::ssize_t>(passed), 1)].cast<py::array>();
}

/// Pupil of a film point as Python exposes it; see the docstrings.
struct PythonFilmPupil {
    double irradiance;
    Array outline;
};

PythonFilmPupil make_film_pupil(const LensSystem& lens, std::pair<double, double> film_mm,
                                std::optional<double> wavelength_nm) {
    const double wavelength = wavelength_or_design(lens, wavelength_nm);
    const FieldPoint field = field_from(0, std::nullopt, film_mm);
    const FilmPupil pupil = [&] {
        const Unlocked unlocked;
        return film_pupil(lens, wavelength, *field.film, parallel_ray_loop(heed_signals));
    }();
    Array outline({static_cast<py::ssize_t>(pupil.outline.size()), py::ssize_t{2}, py::ssize_t{2}});
    double* to = outline.mutable_data();
    for (const auto& piece : pupil.outline)
        for (const Vec2<double> end : piece) {
            *to++ = end.x;
            *to++ = end.y;
        }
    return {pupil.irradiance, outline};
}

}  // namespace

void bind_bundle(py::module_& m) {
    py::class_<RayBundle> bundle(m, "RayBundle",
                                 R"(Rays that represent the light of one object point, at one wavelength, that passes
the lens. They lie at the nodes of Gauss quadrature between the edges of the light. Lens frame; x and y from the axis.
See Lens.bundle.)");
    def_result(bundle, [](const RayBundle& b) {
        const py::ssize_t count = length_of(b.energy), pieces = length_of(b.edge_entry_mm);
        check_arrays('f', {count}, {b.energy, b.path_mm, b.amplitude});
        check_arrays('f', {count, 2}, {b.entry_mm, b.points_mm, b.slopes});
        check_arrays('f', {count, 3}, {b.directions});
        check_arrays('f', {pieces, 2, 2}, {b.edge_entry_mm, b.edge_slopes});
    });
    bundle
        .def_readonly("entry_mm", &RayBundle::entry_mm,
                      R"((N, 2): intersections of the rays with the entry plane in front of the lens, over which the
light is uniform: the plane through the centre of the paraxial entrance pupil, perpendicular to the light.)")
        .def_readonly("energy", &RayBundle::energy, "(N,): fraction of the light of each ray; the sum is 1.")
        .def_readonly("points_mm", &RayBundle::points_mm, "(N, 2): intersections with the film, (x, y) from the axis.")
        .def_readonly("directions", &RayBundle::directions, "(N, 3): unit directions behind the lens.")
        .def_readonly("slopes", &RayBundle::slopes,
                      R"((N, 2): x and y direction cosines, minus those of the spherical wave from the exit pupil to the
chief ray's film point. They are the pupil coordinates in all sums of plane waves.)")
        .def_readonly("path_mm", &RayBundle::path_mm,
                      R"((N,): path of each ray, as a plane wave at the chief ray's film point, minus that of the chief
ray. At the offset q from that point the wave is amplitude * exp(2 pi i index / wavelength * (path + slope . q)).)")
        .def_readonly("amplitude", &RayBundle::amplitude,
                      "(N,): square root of the light per area in slopes, times a common factor.")
        .def_readonly("edge_entry_mm", &RayBundle::edge_entry_mm,
                      "(M, 2, 2): segments of the edge of the light that passes, each from (x, y) to (x, y), in the "
                      "entry plane.")
        .def_readonly("edge_slopes", &RayBundle::edge_slopes,
                      "(M, 2, 2): the same segments in the coordinates of slopes.")
        .def_property_readonly(
            "chief_ray_mm",
            [](const RayBundle& b) { return std::pair(b.chief_ray.film_point_mm[0], b.chief_ray.film_point_mm[1]); },
            "(x, y) on the film of the ray through the centre of the stop, even if the lens blocks it.")
        .def_property_readonly(
            "tangential_focus_mm", [](const RayBundle& b) { return b.chief_ray.tangential_focus_mm; },
            R"(Distance along the axis from the film to the tangential focus, where rays close to the chief ray, in the
plane through it and the axis, intersect; positive: behind the film. nan if there is none.)")
        .def_property_readonly(
            "sagittal_focus_mm", [](const RayBundle& b) { return b.chief_ray.sagittal_focus_mm; },
            "Distance along the axis from the film to the sagittal focus, of rays close to the chief ray in the "
            "perpendicular plane; positive: behind the film. nan if there is none.")
        .def_readonly("film_distance_mm", &RayBundle::film_distance_mm,
                      "Distance from the last vertex to the plane of points_mm.")
        .def_readonly("wavelength_nm", &RayBundle::wavelength_nm, "Wavelength.")
        .def_readonly("index", &RayBundle::index, "Refractive index behind the lens.")
        .def_readonly("mirrored", &RayBundle::mirrored,
                      "True if the second half of the rays are mirror images of the first half, as for every lens "
                      "without diaphragm blades.")
        .def("__repr__", [](const RayBundle& b) {
            return "<realcam.RayBundle " + counted(static_cast<std::size_t>(b.energy.size()), "ray") + " at " +
                   digits(b.wavelength_nm) + " nm>";
        });
    static const std::string text =
        std::string("Traces rays of one object point that fill what the lens transmits, in double precision.\n") +
        kFieldText +
        R"(film_distance_mm: distance from the last vertex to the plane of points_mm; None: the film.
arms: number of radial scan lines about the centre of the light, 4 to 4096. nodes: number of Gauss nodes, 1 to 256, on
  each interval of a scan line on which light passes. The intervals' ends are found with real rays.
Returns a RayBundle. Raises InputError if no light passes, or a glass is unknown at the wavelength.)";
    static const std::string points_text =
        std::string(
            R"(Computes the film points of very many rays of one object point, for spots, histograms and bokeh, at 50
million rays per second and more. The rays uniformly fill a rectangle in front of the lens that contains all light that
passes; they are not aimed at the stop.
)") + kFieldText +
        R"(count: number of rays to trace, up to 2^31; up to a third of them are blocked.
film_distance_mm: distance from the last vertex to the plane of the points; None: the film.
pattern: arrangement of the rays. "even": a low-discrepancy sequence, uniform for any count; "grid": a regular grid.
dtype: precision of the trace, "float32" or "float64". The error of "float32" is below 0.3 um for photographic lenses.
Returns an array (M, 2) of float32, (x, y) in mm from the axis, of the rays that pass. All rays represent the same
amount of light up to the factor (1 + (q / D)^2)^1.5, with q the distance of a ray from the centre of the rectangle and
D the distance of the object. Raises InputError if no light passes.)";
    py::class_<PythonFilmPupil> film_pupil_class(
        m, "FilmPupil",
        R"(Exit pupil as seen from a film point, in optical direction cosines: x and y components of the unit direction
of light travelling to the film, times the refractive index in front of the film. See Lens.film_pupil.)");
    def_result(film_pupil_class,
               [](const PythonFilmPupil& p) { check_arrays('f', {length_of(p.outline), 2, 2}, {p.outline}); });
    film_pupil_class
        .def_readonly("irradiance", &PythonFilmPupil::irradiance,
                      R"(Irradiance of the film point for a scene of uniform unit radiance, which is the pupil's area in
direction cosines: on the axis of a rotationally symmetric lens, pi times sin^2 of the largest angle. 0 if no light
arrives.)")
        .def_readonly("outline", &PythonFilmPupil::outline,
                      "(M, 2, 2): segments of the pupil's edge, each from (x, y) to (x, y).")
        .def("__repr__",
             [](const PythonFilmPupil& p) { return "<realcam.FilmPupil, irradiance " + digits(p.irradiance) + '>'; });
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("bundle", &make_bundle, "field_deg"_a = 0.0, py::kw_only(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(), "film_distance_mm"_a = py::none(), "arms"_a = 64,
             "nodes"_a = 6, text.c_str())
        .def("film_pupil", &make_film_pupil, "film_mm"_a = std::pair(0.0, 0.0), "wavelength_nm"_a = py::none(),
             R"(Finds the exit pupil as seen from a film point, by real rays. film_mm: (x, y) from the film's centre.
wavelength_nm: None: the design wavelength. Returns a FilmPupil. Raises InputError.)")
        .def("film_points", &make_film_points, "field_deg"_a = 0.0, "count"_a = 1000000, py::kw_only(),
             "object_distance_m"_a = py::none(), "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(),
             "film_distance_mm"_a = py::none(), "pattern"_a = "even", "dtype"_a = "float32", points_text.c_str());
}

}  // namespace realcam::bindings
