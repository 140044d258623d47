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
    if (field_deg != 0) throw InputError("field_deg and film_mm both name a field; one of them is wanted");
    if (!std::isfinite(film_mm->first) || !std::isfinite(film_mm->second))
        throw InputError("film_mm must be a point of the film, (x, y) in mm from its middle");
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
    if (!(wavelength_nm >= 100 && wavelength_nm <= 20000))
        throw LensFileError("the design wavelength must lie between 100 and 20000 nm");
    if (!(nearest_focus_m >= 0))
        throw LensFileError("the nearest focus must be 0 (as near as the optics can) or a distance");
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
            "the lens makes no real image of infinity behind its last surface; film_distance_mm is wanted");
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

/// Returns an array of shape (N, 4, 3).
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
                                      "A lens in one state of its rings. A value: every change returns a new Lens.");
    def_hashable_value(lens_class);
    lens_class
        .def(py::init(&make_lens), py::kw_only(), "surfaces"_a, "name"_a = "", "film_distance_mm"_a = py::none(),
             "film_mm"_a = std::pair<double, double>{36, 24}, "wavelength_nm"_a = kLineD_nm, "iris_blades"_a = 0,
             "iris_rounding"_a = 0.0, "iris_rotation_deg"_a = 0.0, "focus_group"_a = py::none(),
             "nearest_focus_m"_a = 0.0, "allow_overlap"_a = false, "film_radius_of_curvature_mm"_a = kInfinity,
             R"(surfaces: from the scene to the film, exactly one of them a Stop.
film_distance_mm: last vertex to film; None: best focus at infinity by real rays.
film_mm: (width, height) used where a Camera names no film.
iris_blades: 0 for a round diaphragm, else 3 to 24; iris_rounding: 0 straight to 1 a circle.
focus_group: (first, last) index of the surfaces that move to focus; None: the whole lens moves.
allow_overlap: for experiments, faces may cross inside their rims, and the film the last face.
film_radius_of_curvature_mm: below 0 the film is hollow towards the lens; inf: flat.
Raises LensFileError, naming the surface (from 1), where the lens cannot be built.)")
        .def_property_readonly("zoom_positions", &zoom_position_names,
                               "Names of the zoom positions; empty: the focal length is fixed.")
        .def_property_readonly("zoom_position", &zoom_position_of,
                               "The current one, or the nearest to it; None: the lens does not zoom.")
        .def_property_readonly("zoom_focal_lengths_mm", &zoom_focal_lengths,
                               "Of the lens at rest in each of its zoom positions.")
        .def("zoomed", &zoomed_to, "position"_a,
             R"(The lens in another zoom position: its name, its index, or, as a float, a focal length in mm between
those of the positions. The plane in focus stays, an open diaphragm stays open, and a closed one keeps
its f-number as far as it opens. Between positions, spacings lie on monotone cubics over the logarithm
of the focal length, which is that of the lens at rest. Raises InputError.)")
        .def(
            "first_order",
            [](const LensSystem& lens, std::optional<double> nm) {
                return first_order(lens, wavelength_or_design(lens, nm));
            },
            "wavelength_nm"_a = py::none(),
            R"(At the design wavelength where none is given. Of a lens that is no centred one of revolution: about the
chief ray of the film's middle, the means of both meridians, so that the f-number is that of the exposure.
How the whole lens is tilted or shifted before the film changes nothing. Raises InputError where the film's
middle gets no light.)")
        .def_property_readonly(
            "f_number", &f_number_at_infinity,
            R"(As engraved: of the lens focused at infinity, with its diaphragm as it stands. A lens that cannot be
focused at infinity has that of first_order().)")
        .def(
            "meridians",
            [](const LensSystem& lens, std::optional<double> nm) {
                const ParabasalData data = parabasal_data(lens, wavelength_or_design(lens, nm));
                return std::pair(data.meridians[0], data.meridians[1]);
            },
            "wavelength_nm"_a = py::none(),
            R"(First-order data in the two principal meridians, about the chief ray of the film's middle; that nearer to
the x axis first. Raises InputError where there is no such ray.)")
        .def(
            "focused", [](const LensSystem& lens, double metres) { return focused(lens, 1000 * metres); },
            "focus_distance_m"_a,
            R"(The lens focused on a plane at this distance from the film, inf allowed: the real rays of the full
aperture make their smallest spot. Raises InputError where the lens cannot.)")
        .def("stopped_down", &stopped_down, "f_number"_a,
             R"(The lens with its diaphragm closed to an f-number: that of the lens focused at infinity, as it is
engraved, whatever the lens is focused on. Raises InputError where it does not open that far.)")
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
            R"(The lens with its rings set, as by zoomed (without indices), stopped_down and focused; None: a ring stays.
opens_as_far_as_it_can: a lens that is not as fast as the f-number is wide open. Raises InputError.)")
        .def("wide_open", &wide_open, "With the diaphragm as wide as its opening.")
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
            "Last vertex to the plane of the smallest RMS spot of an axial point this far in front of the front "
            "vertex;\n"
            "None is the plane in focus.\n"
            "Raises InputError where there is none: no ray passes, or an afocal lens looks at infinity.")
        .def_readonly("name", &LensSystem::name)
        .def_readonly("title", &LensSystem::title)
        .def_readonly("source", &LensSystem::source)
        .def_readonly("surfaces", &LensSystem::surfaces)
        .def_readonly("wavelength_nm", &LensSystem::wavelength_nm)
        .def_readonly("allow_overlap", &LensSystem::allow_overlap)
        .def(
            "overlaps",
            [](const LensSystem& lens) {
                std::vector<std::tuple<int, int, double, double>> list;
                for (const FaceOverlap& c : find_overlaps(lens))
                    list.emplace_back(c.first, c.second, c.depth, c.radius);
                return list;
            },
            R"(Pairs of faces that cross inside their rims, as (first, second, depth_mm, radius_mm): the indices of the
two, how far they reach into each other at most, and how far from the axis that is. Empty but with allow_overlap.)")
        .def_readonly("film_distance_mm", &LensSystem::film_distance)
        .def_readonly("film_radius_of_curvature_mm", &LensSystem::film_radius_of_curvature)
        .def_property_readonly("film_position_mm", &LensSystem::film_position, "Front vertex to film.")
        .def_property_readonly("film_mm", [](const LensSystem& l) { return std::pair(l.film_width, l.film_height); })
        .def_property_readonly("vertices_mm", &LensSystem::vertices,
                               "z of each vertex; of surfaces that are moved, along the axis that is unfolded.")
        .def_property_readonly(
            "surface_frames", [](const LensSystem& l) { return frames_array(surface_frames(l).surfaces); },
            "(N, 4, 3): x, y and z axis of each surface and its vertex in mm, lens frame.")
        .def_property_readonly(
            "film_frame",
            [](const LensSystem& l) {
                return py::array_t<double>(py::object(frames_array({film_frame(l)})[py::int_(0)]));
            },
            "(4, 3): x, y and z axis of the film and its middle in mm, lens frame. Light comes with growing z.")
        .def_property_readonly("focus_distance_m", [](const LensSystem& l) { return l.focus_distance / 1000; })
        .def_property_readonly("nearest_focus_m", [](const LensSystem& l) { return l.focusing.nearest_mm / 1000; })
        .def_property_readonly("stop_index", &LensSystem::stop_index)
        .def_readonly("stop_semi_diameter_mm", &LensSystem::stop_semi_diameter)
        .def_property_readonly("is_rotational", &LensSystem::is_rotational,
                               "Whether this is a centred lens of revolution: no surface is tilted or decentred.")
        .def_property_readonly("iris_blades", [](const LensSystem& l) { return l.iris.blades; })
        .def_property_readonly("iris_rounding", [](const LensSystem& l) { return l.iris.rounding; })
        .def_property_readonly("iris_rotation_deg",
                               [](const LensSystem& l) { return l.iris.rotation_rad * 180 / std::numbers::pi; })
        .def_property_readonly("focus_group", &focus_group_of, "(first, last) index; None: the whole lens moves.")
        .def("__repr__", [](const LensSystem& l) { return text_of(l); });
}

}  // namespace realcam::bindings
