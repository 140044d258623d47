// Methods of Lens that return an edited lens.

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
        R"(Returns the lens with one surface changed.
index: index of the surface in surfaces, from 0. Other arguments: as for Surface(); those that are omitted stay.
Everything else stays, too, also the position of the film: focused() restores the focus. Raises InputError, and
LensFileError if the resulting lens is invalid.)",
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
            R"(Returns the lens with another shape of the diaphragm. blades, rounding, rotation_deg: see Lens(); None:
unchanged. The f-number stays, because the open area does. Raises LensFileError.)")
        .def(
            "with_coating",
            [](const LensSystem& lens, const CoatingLike& coating, const std::optional<std::vector<int>>& surfaces) {
                return surfaces ? with_coating(lens, coating_from(coating), *surfaces)
                                : with_coating(lens, coating_from(coating));
            },
            "coating"_a, "surfaces"_a = py::none(),
            R"(Returns the lens with another coating.
coating: as for Surface(). surfaces: indices of the surfaces to coat, from 0; None: all surfaces for which the coating
is meant: all mirrors for a mirror's coating, otherwise all faces between air and glass, without cemented faces.
Raises InputError, and LensFileError if a coating does not suit its surface.)")
        .def("with_surfaces", &with_surfaces, "surfaces"_a,
             R"(Returns the lens with some surfaces replaced. surfaces: dict of index, from 0, to Surface. Everything
else stays, see Lens.with_surface. Raises InputError, and LensFileError if the resulting lens is invalid.)")
        .def("with_film", &with_film, "width_mm"_a, "height_mm"_a,
             "Returns the lens with another film size, at the same position. Raises LensFileError for invalid sizes.")
        .def("with_film_radius", &with_film_radius, "radius_of_curvature_mm"_a,
             R"(Returns the lens with a film of this radius of curvature; negative: concave towards the lens; inf: flat.
Raises LensFileError if the radius is too short for the film's corners.)")
        .def(
            "shifted",
            [](const LensSystem& lens, double x_mm, double y_mm) {
                return with_lens_moved(lens, {.decentre = {x_mm, y_mm, 0}});
            },
            "x_mm"_a = 0.0, "y_mm"_a = 0.0,
            R"(Returns the lens shifted sideways relative to the film, which stays, as a shift lens. x_mm, y_mm: along
the axes of the lens frame; a positive y_mm moves the field of view upwards.
Raises InputError if the first surface has a decentre or tilt of its own (returns=True), and LensFileError.)")
        .def(
            "tilted",
            [](const LensSystem& lens, double x_deg, double y_deg, double pivot_mm) {
                return with_lens_moved(lens, {.tilt_deg = {x_deg, y_deg, 0}}, pivot_mm);
            },
            "x_deg"_a = 0.0, "y_deg"_a = 0.0, py::kw_only(), "pivot_mm"_a = 0.0,
            R"(Returns the lens tilted relative to the film, which stays, as a tilt lens: the plane in focus tilts
(Scheimpflug). x_deg, y_deg: rotations about the x axis, then about the rotated y axis, each counterclockwise as seen
from the tip of the axis. pivot_mm: distance of the pivot from the film centre, towards the scene.
Raises InputError if the first surface has a decentre or tilt of its own (returns=True), and LensFileError.)")
        .def("scaled", &scaled, "factor"_a,
             R"(Returns the lens with all lengths multiplied by factor, also film, focus distance and zoom positions;
coatings keep their thickness. Raises InputError for a factor that is not positive and finite, and LensFileError if
the resulting lens is invalid.)")
        .def(
            "reversed",
            [](const LensSystem& lens, std::optional<double> film_distance) { return reversed(lens, film_distance); },
            "film_distance_mm"_a = py::none(),
            R"(Returns the reversed lens, with its last surface towards the scene, focused at infinity. Focus group and
zoom positions are retained.
film_distance_mm: distance from the last vertex to the film; None: best focus for infinity.
Raises InputError unless the lens is centred and rotationally symmetric, and LensFileError if infinity has no real
image and film_distance_mm is None.)")
        .def(
            "inserted",
            [](const LensSystem& lens, int index, const std::vector<Surface>& surfaces, std::optional<double> gap) {
                return inserted(lens, index, surfaces, gap);
            },
            "index"_a, "surfaces"_a, py::kw_only(), "gap_mm"_a = py::none(),
            R"(Returns the lens with additional surfaces.
index: they are inserted in front of the surface of this index, from 0, or behind the last surface if it is the number
  of surfaces.
gap_mm: distance from the preceding surface to the first inserted one; None: unchanged. Required behind the last
surface. The film keeps its distance from the last surface, or its position if surfaces are inserted behind that. Focus
group and zoom positions are retained. Raises InputError, and LensFileError if the resulting lens is invalid.)")
        .def(
            "removed",
            [](const LensSystem& lens, int first, std::optional<int> last) {
                return removed(lens, first, last.value_or(first));
            },
            "first"_a, "last"_a = py::none(),
            R"(Returns the lens without the surfaces of index first to last, from 0; last=None: without surface first.
The other surfaces and the film keep their positions; focus group and zoom positions are retained. Raises InputError,
and LensFileError if the resulting lens is invalid.)")
        .def(
            "with_element_tilted",
            [](const LensSystem& lens, int first, std::optional<int> last, double x, double y, double z, double dx,
               double dy, double dz, double pivot) {
                return with_element_tilted(lens, first, last.value_or(first), {{dx, dy, dz}, {x, y, z}, false}, pivot);
            },
            "first"_a, "last"_a = py::none(), py::kw_only(), "x_deg"_a = 0.0, "y_deg"_a = 0.0, "z_deg"_a = 0.0,
            "decentre_x_mm"_a = 0.0, "decentre_y_mm"_a = 0.0, "decentre_z_mm"_a = 0.0, "pivot_mm"_a = 0.0,
            R"(Returns the lens with the surfaces of index first to last, from 0, moved as one rigid element; last=None:
surface first alone. The other surfaces and the film stay. The element is displaced by decentre_*_mm, then rotated about
x, the new y and the new z, like a surface by its tilt_deg. pivot_mm: distance of the pivot behind the first vertex.
Raises InputError, and LensFileError if the resulting lens is invalid.)");
}

}  // namespace realcam::bindings
