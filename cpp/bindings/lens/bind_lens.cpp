// The Python class Lens: constructor, first-order data and the setting of its rings. Other files of this folder add
// analyses, edits and files.

#include <pybind11/stl.h>

#include <tuple>
#include <variant>

#include "../../optics/lens/best_focus.hpp"
#include "../../optics/lens/focus.hpp"
#include "../../optics/lens/parabasal.hpp"
#include "../../optics/lens/rings.hpp"
#include "../../optics/lens/zoom.hpp"
#include "../../optics/prescription/clearance.hpp"
#include "../../optics/prescription/lens_system.hpp"
#include "../../optics/trace/film_frame.hpp"
#include "../bindings.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

FieldPoint field_from(double field_deg, std::optional<double> object_distance_m, const FilmPoint& film_mm) {
    FieldPoint field{field_deg * std::numbers::pi / 180};
    if (object_distance_m) field.object_distance = 1000 * *object_distance_m;
    if (!film_mm) return field;
    if (field_deg != 0) throw InputError("field_deg and film_mm both name a field; specify only one of them");
    if (!std::isfinite(film_mm->first) || !std::isfinite(film_mm->second))
        throw InputError("film_mm must be a point of the film, (x, y) in mm from its centre");
    field.film = Vec2<double>{film_mm->first, film_mm->second};
    return field;
}

double wavelength_or_design(const LensSystem& lens, std::optional<double> nm) {
    if (nm && !(*nm >= 100 && *nm <= 20000)) throw InputError("the wavelength must lie between 100 and 20000 nm");
    return nm.value_or(lens.wavelength_nm);
}

namespace {

LensSystem make_lens(std::vector<Surface> surfaces, const std::string& name, std::optional<double> film_distance,
                     std::pair<double, double> film, double wavelength_nm, int blades, double rounding,
                     double rotation_deg, std::optional<std::pair<int, int>> focus_group, double nearest_focus_m,
                     bool allow_overlap, double film_radius_of_curvature) {
    LensSystem lens;
    lens.allow_overlap = allow_overlap;
    lens.name = name;
    lens.surfaces = std::move(surfaces);
    if (!lens.surfaces.empty()) lens.surfaces.back().thickness = 0;
    lens.wavelength_nm = wavelength_nm;
    lens.film_width = film.first;
    lens.film_height = film.second;
    lens.film_radius_of_curvature = film_radius_of_curvature;
    lens.iris = {blades, rounding, rotation_deg * std::numbers::pi / 180};
    lens.focusing.nearest_mm = 1000 * nearest_focus_m;
    if (focus_group) {
        if (focus_group->first < 0)
            throw LensFileError("the focus group must be (first, last) with 0 <= first <= last");
        lens.focusing.group_first = focus_group->first;
        lens.focusing.group_last = focus_group->second;
    }
    // Set before the checks: its sign decides whether a lens with mirrors is centred and rotationally symmetric.
    lens.film_distance = film_distance.value_or(0);
    validate(lens);
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    if (!film_distance) film_distance = film_distance_at_infinity(lens);
    if (!film_distance)
        throw LensFileError(
            "the lens forms no real image of infinity behind its last surface; film_distance_mm is required");
    lens.film_distance = *film_distance;
    if (const std::string why = film_distance_error(lens); !why.empty()) throw LensFileError(why);
    return lens;
}

std::string text_of(const LensSystem& lens) {
    const std::string name = lens.name.empty() ? "" : ' ' + shortened(lens.name) + ',';
    const std::string focus = std::isinf(lens.focus_distance) ? "infinity" : digits(lens.focus_distance / 1000) + " m";
    const std::string begin = "<realcam.Lens" + name + ' ' + counted(lens.surfaces.size(), "surface") + ", ";
    const FirstOrder data = nominal_first_order(lens);
    const std::string why = lens.asymmetry();
    return begin + (why.empty() ? "" : why + ", ") + digits(data.effective_focal_length) + " mm f/" +
           digits(data.f_number) + ", focused at " + focus + '>';
}

/// Returns an array of shape (N, 4, 3): x, y and z axis and origin of each frame.
py::array_t<double> frames_array(const std::vector<Affine<double>>& frames) {
    py::array_t<double> array({static_cast<py::ssize_t>(frames.size()), py::ssize_t{4}, py::ssize_t{3}});
    double* to = array.mutable_data();
    for (const Affine<double>& frame : frames)
        for (const Vec3d& v : {frame.x, frame.y, frame.z, frame.origin}) {
            *to++ = v.x;
            *to++ = v.y;
            *to++ = v.z;
        }
    return array;
}

std::optional<std::pair<int, int>> focus_group_of(const LensSystem& lens) {
    if (!lens.focusing.moves_group()) return std::nullopt;
    return std::pair(lens.focusing.group_first, lens.focusing.group_last);
}

std::vector<std::string> zoom_position_names(const LensSystem& lens) {
    std::vector<std::string> names;
    for (const ZoomPosition& position : lens.zoom.positions) names.push_back(position.name);
    return names;
}

std::optional<std::string> zoom_position_of(const LensSystem& lens) {
    if (lens.zoom.positions.empty()) return std::nullopt;
    return lens.zoom.positions[static_cast<std::size_t>(lens.zoom.current)].name;
}

/// An int is the index of a zoom position and a float is a focal length: Python distinguishes 1 and 1.0.
LensSystem zoomed_to(const LensSystem& lens, const std::variant<std::string, int, double>& to) {
    if (const double* focal_length_mm = std::get_if<double>(&to)) return zoomed_to_focal_length(lens, *focal_length_mm);
    if (const int* position = std::get_if<int>(&to)) return zoomed(lens, *position);
    return zoomed(lens, std::get<std::string>(to));
}

}  // namespace

void bind_lens(py::module_& m) {
    py::class_<LensSystem> lens_class(m, "Lens",
                                      R"(Lens with the current setting of its focus, zoom and aperture rings. Immutable:
every change returns a new Lens. Lens frame: origin at the front vertex, z along the axis towards the film, mm.)");
    def_hashable_value(lens_class);
    lens_class
        .def(py::init(&make_lens), py::kw_only(), "surfaces"_a, "name"_a = "", "film_distance_mm"_a = py::none(),
             "film_mm"_a = std::pair<double, double>{36, 24}, "wavelength_nm"_a = kLineD_nm, "iris_blades"_a = 0,
             "iris_rounding"_a = 0.0, "iris_rotation_deg"_a = 0.0, "focus_group"_a = py::none(),
             "nearest_focus_m"_a = 0.0, "allow_overlap"_a = false, "film_radius_of_curvature_mm"_a = kInfinity,
             R"(surfaces: Surfaces in order from the scene to the film; exactly one must have the type "stop".
name: name of the lens.
film_distance_mm: distance from the last vertex to the film; None: best focus for infinity by real rays.
film_mm: (width, height) of the film that a Camera uses by default.
wavelength_nm: design wavelength, 100 to 20000.
iris_blades: number of diaphragm blades, 3 to 24; 0: a round diaphragm. iris_rounding: 0 for straight blade edges
  to 1 for a circle. iris_rotation_deg: rotation of the diaphragm about the axis.
focus_group: (first, last) index of the surfaces that move for focusing; None: the whole lens moves.
nearest_focus_m: nearest focus distance, from the object to the film; 0: limited only by the optics.
allow_overlap: allows faces to cross inside their clear semi-diameters, and the film to cross the last face.
film_radius_of_curvature_mm: radius of curvature of the film; negative: concave towards the lens; inf: flat.
Raises LensFileError, with the number of the surface (from 1), if the lens is invalid.)")
        .def_property_readonly("zoom_positions", &zoom_position_names,
                               "Names of the zoom positions; empty if the focal length is fixed.")
        .def_property_readonly("zoom_position", &zoom_position_of,
                               "Name of the current, or the nearest, zoom position; None if the lens does not zoom.")
        .def_property_readonly("zoom_focal_lengths_mm", &zoom_focal_lengths,
                               "Focal length in each zoom position, of the lens focused at infinity.")
        .def("zoomed", &zoomed_to, "position"_a,
             R"(Returns the lens in another zoom position.
position: its name (str), its index (int), or a focal length in mm (float) between those of the positions, of the
  lens focused at infinity.
The plane in focus stays. A wide-open diaphragm stays wide open; a closed one keeps its f-number, as far as it can
open. Between positions, spacings are interpolated by monotone cubics over the logarithm of the focal length.
Raises InputError.)")
        .def(
            "first_order",
            [](const LensSystem& lens, std::optional<double> nm) {
                return first_order(lens, wavelength_or_design(lens, nm));
            },
            "wavelength_nm"_a = py::none(),
            R"(Returns the FirstOrder data at a wavelength; None: the design wavelength.
For a lens that is not centred and rotationally symmetric they hold about the chief ray of the film centre, as means
of both principal meridians, so that the f-number determines the exposure. A tilt or shift of the whole lens
relative to the film has no influence. Raises InputError if no light reaches the film centre.)")
        .def_property_readonly(
            "f_number", &f_number_at_infinity,
            R"(f-number as engraved: of the lens focused at infinity, with its current diaphragm; that of first_order()
if the lens cannot be focused at infinity.)")
        .def(
            "meridians",
            [](const LensSystem& lens, std::optional<double> nm) {
                const ParabasalData data = parabasal_data(lens, wavelength_or_design(lens, nm));
                return std::pair(data.meridians[0], data.meridians[1]);
            },
            "wavelength_nm"_a = py::none(),
            R"(Returns the pair of principal Meridians, about the chief ray of the film centre; the one nearer to the x
axis first. wavelength_nm: None: the design wavelength. Raises InputError if there is no such chief ray.)")
        .def(
            "focused", [](const LensSystem& lens, double metres) { return focused(lens, 1000 * metres); },
            "focus_distance_m"_a,
            R"(Returns the lens focused on the plane at this distance from the film, inf allowed. Best focus: the
smallest RMS spot of real rays through the full aperture. Raises InputError if the lens cannot be focused there.)")
        .def("stopped_down", &stopped_down, "f_number"_a,
             R"(Returns the lens with its diaphragm set to an f-number as engraved, which is that of the lens focused at
infinity, whatever the lens is focused on. Raises InputError if the diaphragm does not open that far.)")
        .def(
            "with_rings",
            [](const LensSystem& lens, const std::optional<std::variant<std::string, double>>& zoom,
               std::optional<double> f_number, std::optional<double> focus_m, bool opens_as_far_as_it_can) {
                Rings rings;
                rings.f_number = f_number;
                rings.opens_as_far_as_it_can = opens_as_far_as_it_can;
                if (zoom) std::visit([&](const auto& to) { rings.zoom = to; }, *zoom);
                if (focus_m) rings.focus_distance = 1000 * *focus_m;
                return with_rings(lens, rings);
            },
            py::kw_only(), "zoom"_a = py::none(), "f_number"_a = py::none(), "focus_m"_a = py::none(),
            "opens_as_far_as_it_can"_a = false,
            R"(Returns the lens with its rings set; None: a ring is not moved.
zoom: name of a zoom position, or a focal length in mm, see Lens.zoomed. f_number: see Lens.stopped_down. focus_m: see
Lens.focused.
opens_as_far_as_it_can: if the lens is slower than f_number, open it fully instead of raising an error.
Raises InputError.)")
        .def("wide_open", &wide_open, "Returns the lens with its diaphragm fully open.")
        .def(
            "best_focus_mm",
            [](const LensSystem& lens, std::optional<double> object_m, std::optional<double> nm) {
                const double object = object_distance_of(lens, field_from(0, object_m));
                const double plane = best_focus_distance(lens, wavelength_or_design(lens, nm), object);
                if (!std::isfinite(plane))
                    throw InputError(
                        "lens \"" + lens.name +
                        "\" has no best focus: no ray from the object passes it, or its light leaves parallel");
                return plane;
            },
            "object_distance_m"_a = py::none(), "wavelength_nm"_a = py::none(),
            R"(Returns the distance in mm from the last vertex to the plane with the smallest RMS spot of an axial
point.
object_distance_m: distance from the object plane to the front vertex, inf allowed; None: the plane in focus.
wavelength_nm: None: the design wavelength.
Raises InputError if there is no best focus: no ray passes, or the lens is afocal and the object at infinity.)")
        .def_readonly("name", &LensSystem::name, "Name, which identifies a bundled lens.")
        .def_readonly("title", &LensSystem::title, "Description in one line; may be empty.")
        .def_readonly("source", &LensSystem::source, "Origin of the prescription, such as a patent; may be empty.")
        .def_readonly("surfaces", &LensSystem::surfaces, "List of Surfaces, from the scene to the film.")
        .def_readonly("wavelength_nm", &LensSystem::wavelength_nm, "Design wavelength.")
        .def_readonly("allow_overlap", &LensSystem::allow_overlap, "True if faces may cross, see Lens().")
        .def(
            "overlaps",
            [](const LensSystem& lens) {
                std::vector<std::tuple<int, int, double, double>> list;
                for (const FaceOverlap& c : find_overlaps(lens))
                    list.emplace_back(c.first, c.second, c.depth, c.radius);
                return list;
            },
            R"(Returns pairs of faces that cross inside their clear semi-diameters, as tuples (first, second, depth_mm,
radius_mm): their indices, the largest depth of the overlap along the axis, and its distance from the axis. The list
is empty unless allow_overlap is True.)")
        .def_readonly("film_distance_mm", &LensSystem::film_distance, "Distance from the last vertex to the film.")
        .def_readonly("film_radius_of_curvature_mm", &LensSystem::film_radius_of_curvature,
                      "Radius of curvature of the film; negative: concave towards the lens; inf: flat.")
        .def_property_readonly("film_position_mm", &LensSystem::film_position,
                               "Distance from the front vertex to the film.")
        .def_property_readonly(
            "film_mm", [](const LensSystem& l) { return std::pair(l.film_width, l.film_height); },
            "(width, height) of the film that a Camera uses by default.")
        .def_property_readonly(
            "vertices_mm", &LensSystem::vertices,
            R"(z of each surface's vertex; if surfaces are tilted or decentred, the position along the unfolded axis.)")
        .def_property_readonly(
            "surface_frames", [](const LensSystem& l) { return frames_array(surface_frames(l).surfaces); },
            "(N, 4, 3): x, y and z axis (unit) and vertex (mm) of each surface, lens frame.")
        .def_property_readonly(
            "film_frame",
            [](const LensSystem& l) {
                return py::array_t<double>(py::object(frames_array({film_frame(l)})[py::int_(0)]));
            },
            "(4, 3): x, y and z axis (unit) and centre (mm) of the film, lens frame. Light arrives in +z direction of "
            "this frame.")
        .def_property_readonly(
            "focus_distance_m", [](const LensSystem& l) { return l.focus_distance / 1000; },
            "Distance from the plane in focus to the film; inf allowed.")
        .def_property_readonly(
            "nearest_focus_m", [](const LensSystem& l) { return l.focusing.nearest_mm / 1000; },
            "Nearest focus distance, from the object to the film; 0: limited only by the optics.")
        .def_property_readonly("stop_index", &LensSystem::stop_index, "Index of the aperture stop in surfaces.")
        .def_readonly("stop_semi_diameter_mm", &LensSystem::stop_semi_diameter,
                      "Radius of the diaphragm's current opening.")
        .def_property_readonly("is_rotational", &LensSystem::is_rotational,
                               "True if the lens is rotationally symmetric: centred, and without freeform surfaces.")
        .def_property_readonly(
            "iris_blades", [](const LensSystem& l) { return l.iris.blades; },
            "Number of diaphragm blades; 0: the diaphragm is round.")
        .def_property_readonly(
            "iris_rounding", [](const LensSystem& l) { return l.iris.rounding; },
            "0 for straight blade edges to 1 for a circle.")
        .def_property_readonly(
            "iris_rotation_deg", [](const LensSystem& l) { return l.iris.rotation_rad * 180 / std::numbers::pi; },
            "Rotation of the diaphragm about the axis.")
        .def_property_readonly(
            "focus_group", &focus_group_of,
            "(first, last) index of the surfaces that move for focusing; None: the whole lens moves.")
        .def("__repr__", [](const LensSystem& l) { return text_of(l); });
}

}  // namespace realcam::bindings
