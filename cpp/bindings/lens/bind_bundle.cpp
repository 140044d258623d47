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

constexpr int kBundleLook = 12;  ///< rays across the stop in the initial search for the transmitted light

struct ChiefRay {
    std::array<double, 2> at_mm;
    double tangential_focus_mm, sagittal_focus_mm;
};

struct RayBundle {
    Array entry_mm, energy, points_mm, directions, slopes, path_mm, amplitude;
    Array edge_entry_mm, edge_slopes;
    ChiefRay chief_ray;
    double film_distance_mm, wavelength_nm, index;
    bool mirrored;
};

Array edge_array(const std::vector<EdgePiece>& edge, Vec2<double> (*of)(const EdgePiece&, std::size_t)) {
    Array array({static_cast<py::ssize_t>(edge.size()), py::ssize_t{2}, py::ssize_t{2}});
    double* to = array.mutable_data();
    for (const EdgePiece& piece : edge)
        for (std::size_t end = 0; end < 2; ++end) {
            const Vec2<double> point = of(piece, end);
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
        PointBundle made(lens, wavelength, field, distance, loop, kBundleLook);
        TracedBundle rays = traced_bundle(made, {arms, nodes}, loop);
        return std::pair(std::move(made), std::move(rays));
    }();
    const std::vector<BundleRay>& rays = traced.rays;
    const auto pair_of = [&](auto&& f) {
        return table_of(rays.size(), 2, [&](auto i, auto k) { return k == 0 ? f(rays[i]).x : f(rays[i]).y; });
    };
    const auto number_of = [&](auto&& f) { return array_of(rays.size(), [&](auto i) { return f(rays[i]); }); };
    const auto component = [](Vec3d v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; };
    const Vec2<double> chief = bundle.chief;
    return {
        pair_of([](const BundleRay& ray) { return Vec2<double>{ray.entry.x, ray.entry.y}; }),
        number_of([](const BundleRay& ray) { return ray.energy; }),
        pair_of([&](const BundleRay& ray) { return Vec2<double>{ray.at.x + chief.x, ray.at.y + chief.y}; }),
        table_of(rays.size(), 3, [&](auto i, auto k) { return component(rays[i].direction, k); }),
        pair_of([](const BundleRay& ray) { return ray.wave.slope; }),
        number_of([](const BundleRay& ray) { return ray.wave.path; }),
        number_of([](const BundleRay& ray) { return ray.amplitude; }),
        edge_array(traced.edge, [](const EdgePiece& piece,
                                   std::size_t end) { return Vec2<double>{piece.entry[end].x, piece.entry[end].y}; }),
        edge_array(traced.edge, [](const EdgePiece& piece, std::size_t end) { return piece.slope[end]; }),
        {{chief.x, chief.y}, traced.tangential_focus, traced.sagittal_focus},
        distance,
        wavelength,
        bundle.index,
        bundle.mirrored};
}

/// Returns an array (M, 2) of float32: the film points of those of `count` rays that pass.
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
        throw InputError("unknown pattern \"" + pattern + "\"; even or grid is wanted");
    const py::dtype type = py::dtype::from_args(dtype);
    if (type.kind() != 'f' || (type.itemsize() != 4 && type.itemsize() != 8))
        throw InputError("dtype must be \"float64\" or \"float32\"");
    const FieldPoint field = field_from(field_deg, object_distance_m, film_mm);
    const double distance = film_distance_mm.value_or(lens.film_distance);
    py::array_t<float> points({static_cast<py::ssize_t>(count), py::ssize_t{2}});
    float* to = points.mutable_data();
    const std::int64_t passed = [&] {
        const Unlocked unlocked;
        const PointBundle bundle(lens, wavelength, field, distance, parallel_ray_loop(heed_signals), kBundleLook);
        return find_film_points(lens, wavelength, bundle, pattern == "even" ? EntryPattern::even : EntryPattern::grid,
                                type.itemsize() == 8 ? Precision::float64 : Precision::float32, count, bundle.plane(),
                                to, heed_signals);
    }();
    return points[py::slice(0, static_cast<py::ssize_t>(passed), 1)].cast<py::array>();
}

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

template <>
struct RestoredCheck<PythonFilmPupil> {
    static void check(const PythonFilmPupil& p) {
        check_restored_array(p.outline, {'f', {restored_length(p.outline), 2, 2}});
    }
};
template <>
struct RestoredCheck<ChiefRay> : AnyMembers {};
template <>
struct RestoredCheck<RayBundle> {
    static void check(const RayBundle& b) {
        const py::ssize_t count = restored_length(b.energy), pieces = restored_length(b.edge_entry_mm);
        for (const Array* numbers : {&b.energy, &b.path_mm, &b.amplitude})
            check_restored_array(*numbers, {'f', {count}});
        for (const Array* pairs : {&b.entry_mm, &b.points_mm, &b.slopes})
            check_restored_array(*pairs, {'f', {count, 2}});
        check_restored_array(b.directions, {'f', {count, 3}});
        for (const Array* edge : {&b.edge_entry_mm, &b.edge_slopes}) check_restored_array(*edge, {'f', {pieces, 2, 2}});
    }
};

void bind_bundle(py::module_& m) {
    py::class_<RayBundle> bundle(m, "RayBundle",
                                 R"(The light of one object point at one wavelength that passes the lens, as rays at
Gauss's nodes between its edges. Lens frame; x and y from the axis.)");
    def_result(bundle);
    bundle
        .def_readonly("entry_mm", &RayBundle::entry_mm,
                      R"((N, 2): where the rays cross the plane before the lens over which the light is even: through
the middle of the paraxial entrance pupil, across the light.)")
        .def_readonly("energy", &RayBundle::energy, "(N,): shares of the light; their sum is 1.")
        .def_readonly("points_mm", &RayBundle::points_mm, "(N, 2): on the film, from the axis.")
        .def_readonly("directions", &RayBundle::directions, "(N, 3), unit: behind the lens.")
        .def_readonly("slopes", &RayBundle::slopes,
                      R"((N, 2): direction cosines x and y, less those of the sphere that runs from the exit pupil to
the chief ray's film point: the pupil's coordinates in all sums of waves.)")
        .def_readonly("path_mm", &RayBundle::path_mm,
                      R"((N,): of each ray as a plane wave at the chief ray's film point, less that of the chief ray:
amplitude exp(2 pi i index / wavelength (path + slope . q)) at q from there.)")
        .def_readonly("amplitude", &RayBundle::amplitude,
                      "(N,): root of the light for each area of slopes, times a common factor.")
        .def_readonly("edge_entry_mm", &RayBundle::edge_entry_mm,
                      "(M, 2, 2): pieces of the edge of what passes, from (x, y) to (x, y), as entry_mm.")
        .def_readonly("edge_slopes", &RayBundle::edge_slopes, "(M, 2, 2): the same, as slopes.")
        .def_property_readonly(
            "chief_ray_mm", [](const RayBundle& b) { return std::pair(b.chief_ray.at_mm[0], b.chief_ray.at_mm[1]); },
            "(x, y) on the film, of the ray through the middle of the stop, even where the lens blocks it.")
        .def_property_readonly(
            "tangential_focus_mm", [](const RayBundle& b) { return b.chief_ray.tangential_focus_mm; },
            R"(Along the axis from the film to where rays close to the chief ray cross that differ from it in the plane
of the axis; positive: behind the film. nan where the lens has none.)")
        .def_property_readonly(
            "sagittal_focus_mm", [](const RayBundle& b) { return b.chief_ray.sagittal_focus_mm; },
            "The same, of rays beside that plane.")
        .def_readonly("film_distance_mm", &RayBundle::film_distance_mm, "Last vertex to the film, or to another plane.")
        .def_readonly("wavelength_nm", &RayBundle::wavelength_nm)
        .def_readonly("index", &RayBundle::index, "Behind the lens.")
        .def_readonly("mirrored", &RayBundle::mirrored,
                      "Whether the second half of the rays are the mirror images of the first, as of all lenses "
                      "without blades.")
        .def("__repr__", [](const RayBundle& b) {
            return "<realcam.RayBundle " + counted(static_cast<std::size_t>(b.energy.size()), "ray") + " at " +
                   digits(b.wavelength_nm) + " nm>";
        });
    static const std::string text =
        std::string("Rays of one object point that fill what the lens lets pass, in double precision.\n") + kFieldText +
        R"(film_distance_mm: last vertex to the plane that points_mm lie in; None: the film.
arms, nodes: number of radial arms about the centre of the light, and of Gauss nodes on each interval of an arm on which
light passes; real rays find the intervals' ends.
Returns a RayBundle. Raises InputError where no light passes, or a glass is not known at the wavelength.)";
    static const std::string points_text =
        std::string(
            R"(Where very many rays of one object point land, for spots, histograms and bokeh: 50 million a second and
more. They fill a rectangle in front of the lens that holds all light that passes, evenly, and are not aimed at the
stop.
)") + kFieldText +
        R"(count: rays to trace; up to a third of them are blocked.
film_distance_mm: last vertex to the plane of the points; None: the film.
pattern: "even", a sequence that is spread evenly for any count, or "grid".
dtype: of the trace. "float32" is right within 0.3 um for photographic lenses.
Returns (M, 2) float32, x and y in mm from the axis, of the rays that pass. All stand for the same light, but for
(1 + (q / D)^2)^1.5, q the distance from the ray that is even and D that of the object.
Raises InputError where no light passes.)";
    py::class_<PythonFilmPupil> film_pupil_class(
        m, "FilmPupil",
        R"(The pupil as a film point sees it, in direction cosines across the film's normal of light on its way to the
film, times the index in front of the film.)");
    def_result(film_pupil_class);
    film_pupil_class
        .def_readonly("irradiance", &PythonFilmPupil::irradiance,
                      R"(Of the film point, for unit radiance of all that the lens sees: the pupil's area, in the middle
of a lens of revolution pi sin^2 of the largest angle. 0 where no light arrives.)")
        .def_readonly("outline", &PythonFilmPupil::outline,
                      "(M, 2, 2): pieces of the edge of what passes, each from (x, y) to (x, y).")
        .def("__repr__",
             [](const PythonFilmPupil& p) { return "<realcam.FilmPupil, irradiance " + digits(p.irradiance) + '>'; });
    py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"))
        .def("bundle", &make_bundle, "field_deg"_a = 0.0, py::kw_only(), "object_distance_m"_a = py::none(),
             "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(), "film_distance_mm"_a = py::none(), "arms"_a = 64,
             "nodes"_a = 6, text.c_str())
        .def("film_pupil", &make_film_pupil, "film_mm"_a = std::pair(0.0, 0.0), "wavelength_nm"_a = py::none(),
             "The pupil as a film point sees it, (x, y) from the film's middle, by real rays.")
        .def("film_points", &make_film_points, "field_deg"_a = 0.0, "count"_a = 1000000, py::kw_only(),
             "object_distance_m"_a = py::none(), "film_mm"_a = py::none(), "wavelength_nm"_a = py::none(),
             "film_distance_mm"_a = py::none(), "pattern"_a = "even", "dtype"_a = "float32", points_text.c_str());
}

}  // namespace realcam::bindings
