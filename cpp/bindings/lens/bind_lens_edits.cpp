#include <pybind11/stl.h>

#include "../../optics/lens/lens_changes.hpp"
#include "../../optics/lens/lens_edits.hpp"
#include "../bindings.hpp"
#include "surface_changes.hpp"

namespace realcam::bindings {

using namespace py::literals;

void bind_lens_edits(py::module_& m) {
    auto lens_class = py::reinterpret_borrow<py::class_<LensSystem>>(m.attr("Lens"));
    def_surface_changes(
        lens_class, "with_surface",
        [](const LensSystem& lens, int index, const SurfaceChanges& changes) {
            const bool exists = index >= 0 && index < static_cast<int>(lens.surfaces.size());
            return with_surface(
                lens, index,
                exists ? changed_surface(lens.surfaces[static_cast<std::size_t>(index)], changes) : Surface());
        },
        R"(The lens with one surface changed: its index from 0, as in surfaces, and what Surface() takes. What is not
given stays; so do focus group, iris, film and title, and the film where it is: focused() brings the picture
into focus again. Raises InputError, and LensFileError where the lens cannot be built.)",
        "index"_a);
    lens_class
        .def(
            "with_iris",
            [](const LensSystem& lens, int blades, std::optional<double> rounding, std::optional<double> rotation_deg) {
                const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
                return with_iris(lens, {blades, rounding.value_or(lens.iris.rounding),
                                        rotation_deg ? radians(*rotation_deg) : lens.iris.rotation_rad});
            },
            "blades"_a, "rounding"_a = py::none(), "rotation_deg"_a = py::none(),
            R"(The lens with another diaphragm: blades, rounding and rotation as Lens() takes them; None stays. The
f-number stays too, because it is the open area that it means. Raises LensFileError.)")
        .def(
            "with_coating",
            [](const LensSystem& lens, const CoatingLike& coating, const std::optional<std::vector<int>>& surfaces) {
                return surfaces ? with_coating(lens, coating_from(coating), *surfaces)
                                : with_coating(lens, coating_from(coating));
            },
            "coating"_a, "surfaces"_a = py::none(),
            R"(The lens with another coating, as Surface() takes it, on the surfaces of these indices; None: on all that
it is for, a mirror's on all mirrors, any other on all faces between air and glass. Cemented faces stay as they are.
Raises InputError, and LensFileError where a coating does not fit its surface.)")
        .def("with_surfaces", &with_surfaces, "surfaces"_a,
             R"(The lens with other surfaces in place of some: a dict of index, from 0, and Surface. All else stays, as
in with_surface. Raises InputError, and LensFileError where the lens cannot be built.)")
        .def("with_film", &with_film, "width_mm"_a, "height_mm"_a,
             "The lens for another film, at its place. Raises LensFileError for sizes that are none.")
        .def("with_film_radius", &with_film_radius, "radius_of_curvature_mm"_a,
             R"(The lens for a film of this radius of curvature: below 0 hollow towards the lens, inf flat.
Raises LensFileError where the film does not reach its corners.)")
        .def(
            "shifted",
            [](const LensSystem& lens, double x_mm, double y_mm) {
                return with_lens_moved(lens, {.decentre = {x_mm, y_mm, 0}});
            },
            "x_mm"_a = 0.0, "y_mm"_a = 0.0,
            R"(The lens moved sideways before the film, which stays. A lens that goes up, y_mm above 0, looks up.
Raises InputError where its first surface is moved alone, and LensFileError.)")
        .def(
            "tilted",
            [](const LensSystem& lens, double x_deg, double y_deg, double pivot_mm) {
                return with_lens_moved(lens, {.tilt_deg = {x_deg, y_deg, 0}}, pivot_mm);
            },
            "x_deg"_a = 0.0, "y_deg"_a = 0.0, py::kw_only(), "pivot_mm"_a = 0.0,
            R"(The lens turned before the film, which stays: about the x axis, then the turned y axis, each
counterclockwise as seen from its tip. The plane in focus turns with it (Scheimpflug).
pivot_mm: from the middle of the film towards the scene to the point about which it turns.
Raises InputError where its first surface is moved alone, and LensFileError.)")
        .def("scaled", &scaled, "factor"_a,
             R"(The lens with all lengths times factor: film, focus distance and zoom positions with it; coatings keep
their thickness. Raises InputError for a factor that is not positive and finite, and LensFileError where
the lens cannot be built.)")
        .def(
            "reversed",
            [](const LensSystem& lens, std::optional<double> film_distance) { return reversed(lens, film_distance); },
            "film_distance_mm"_a = py::none(),
            R"(The lens turned round, its last surface towards the scene, focused at infinity.
film_distance_mm: last vertex to film; None: where infinity is sharpest. Focus group and zoom positions
are kept. Raises LensFileError where infinity has no real image and no distance is given.)")
        .def(
            "inserted",
            [](const LensSystem& lens, int index, const std::vector<Surface>& surfaces, std::optional<double> gap) {
                return inserted(lens, index, surfaces, gap);
            },
            "index"_a, "surfaces"_a, py::kw_only(), "gap_mm"_a = py::none(),
            R"(The lens with surfaces put in front of the one of this index, from 0; behind the last one if the index is
their number.
gap_mm: from the surface before them to the first; None: as it is. Wanted behind the last surface.
The film keeps its distance from the last surface, and its place where surfaces are put behind that.
Focus group and zoom positions are kept. Raises InputError, and LensFileError where the lens cannot be
built.)")
        .def(
            "removed",
            [](const LensSystem& lens, int first, std::optional<int> last) {
                return removed(lens, first, last.value_or(first));
            },
            "first"_a, "last"_a = py::none(),
            R"(The lens without the surfaces of index first to last, from 0; None: first alone. What is left stays in
its place, film, focus group and zoom positions too. Raises InputError, and LensFileError where the lens cannot be
built.)")
        .def(
            "with_element_tilted",
            [](const LensSystem& lens, int first, std::optional<int> last, double x, double y, double z, double dx,
               double dy, double dz, double pivot) {
                return with_element_tilted(lens, first, last.value_or(first), {{dx, dy, dz}, {x, y, z}, false}, pivot);
            },
            "first"_a, "last"_a = py::none(), py::kw_only(), "x_deg"_a = 0.0, "y_deg"_a = 0.0, "z_deg"_a = 0.0,
            "decentre_x_mm"_a = 0.0, "decentre_y_mm"_a = 0.0, "decentre_z_mm"_a = 0.0, "pivot_mm"_a = 0.0,
            R"(The lens with the surfaces of index first to last, from 0, moved as one rigid piece; None: first alone.
The rest and the film stay in place. The piece is decentred, then turned about x, its new y and its new
z, as a surface is by its tilt_deg. pivot_mm: how far behind the first vertex the point lies that it turns
about. Raises InputError, and LensFileError where the lens cannot be built.)");
}

}  // namespace realcam::bindings
