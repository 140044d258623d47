#include <pybind11/stl.h>

#include <map>
#include <tuple>
#include <variant>

#include "../io/lens/lens_format.hpp"
#include "../io/lens/lens_glass.hpp"
#include "../optics/lens/best_focus.hpp"
#include "../optics/lens/focus.hpp"
#include "../optics/lens/lens_changes.hpp"
#include "../optics/lens/parabasal.hpp"
#include "../optics/lens/zoom.hpp"
#include "../optics/prescription/clearance.hpp"
#include "../optics/prescription/surface_frames.hpp"
#include "../optics/trace/film_frame.hpp"
#include "bindings.hpp"
#include "coating_from.hpp"
#include "form_from.hpp"
#include "short_text.hpp"
#include "triples.hpp"
#include "value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

Glass glass_from(const py::object& material) {
    if (material.is_none()) return Glass::air();
    if (py::isinstance<Glass>(material)) return material.cast<Glass>();
    if (py::isinstance<py::str>(material)) return io::catalogue_glass(material.cast<std::string>());
    if (py::isinstance<py::sequence>(material)) {
        std::vector<double> pair;
        try {
            pair = material.cast<std::vector<double>>();
        } catch (const py::cast_error&) {
            // Named below: not two numbers.
        }
        if (pair.size() != 2) throw InputError("a material given as a pair must be (n_d, V_d)");
        Glass glass = Glass::from_abbe_number(pair[0], pair[1]);
        glass.label = py::str(material).cast<std::string>();
        return glass;
    }
    double index = 0;
    try {
        index = material.cast<double>();
    } catch (const py::cast_error&) {
        throw InputError("a material must be an index, (n_d, V_d), the name of a glass, a Glass or None (air)");
    }
    Glass glass = Glass::constant(index);
    if (index != 1) glass.label = py::str(material).cast<std::string>();
    return glass;
}

FieldPoint field_from(double field_deg, std::optional<double> object_distance_m, const FilmPlace& film_mm) {
    FieldPoint field{field_deg * std::numbers::pi / 180};
    if (object_distance_m) field.object_distance = 1000 * *object_distance_m;
    if (!film_mm) return field;
    if (field_deg != 0) throw InputError("field_deg and film_mm both name a field; one of them is wanted");
    if (!std::isfinite(film_mm->first) || !std::isfinite(film_mm->second))
        throw InputError("film_mm must be a place on the film, (x, y) in mm from its middle");
    field.film = Vec2<double>{film_mm->first, film_mm->second};
    return field;
}

double wavelength_or_design(const LensSystem& lens, std::optional<double> nm) {
    if (nm && !(*nm >= 100 && *nm <= 20000)) throw InputError("the wavelength must lie between 100 and 20000 nm");
    return nm.value_or(lens.wavelength_nm);
}

namespace {

constexpr const char* kTypeNames[] = {"refracting", "mirror", "stop", "aperture"};

SurfaceType type_from(const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (name == kTypeNames[i]) return static_cast<SurfaceType>(i);
    throw InputError("unknown surface type \"" + name + "\"; refracting, mirror, stop or aperture is wanted");
}

/// What a user gives of a surface; the rest stays as it is.
struct SurfaceChanges {
    std::optional<double> radius_of_curvature_mm, thickness_mm;
    std::optional<Glass> material;
    std::optional<double> clear_semi_diameter_mm, conic;
    std::optional<std::map<int, double>> aspheric_coefficients;
    std::optional<double> inner_semi_diameter_mm;
    std::optional<std::string> type;
    std::optional<Coating> coating;
    std::optional<std::vector<double>> decentre_mm, tilt_deg;
    std::optional<bool> returns;
    FormChanges form;
};

std::vector<double> aspheric_from(const std::map<int, double>& coefficients) {
    std::vector<double> list;
    for (const auto& [power, value] : coefficients) {
        if (power < 4 || power % 2 != 0 || power > 2 * kMaxAsphericTerms + 2)
            throw InputError("aspheric coefficients have even powers from 4 to " +
                             std::to_string(2 * kMaxAsphericTerms + 2) + " as keys; one is " + std::to_string(power));
        const auto term = static_cast<std::size_t>(power / 2 - 2);
        if (list.size() <= term) list.resize(term + 1, 0.0);
        list[term] = value;
    }
    return list;
}

/// x, y and z; of a decentre z may be left out.
Vec3d triple_from(const std::vector<double>& values, std::size_t least, const char* what) {
    if (values.size() < least || values.size() > 3)
        throw InputError(std::string(what) + " is " + (least < 3 ? "(x, y) or (x, y, z)" : "(x, y, z)"));
    return {values[0], values[1], values.size() > 2 ? values[2] : 0};
}

Surface changed(Surface surface, const SurfaceChanges& to) {
    if (to.type) surface.type = type_from(*to.type);
    if (to.radius_of_curvature_mm) {
        const double radius = *to.radius_of_curvature_mm;
        if (radius == 0 || std::isnan(radius))
            throw InputError("a radius of curvature of 0 is no surface; leave it out (or give inf) for a plane");
        surface.curvature = 1 / radius;
    }
    if (to.aspheric_coefficients) surface.aspheric = aspheric_from(*to.aspheric_coefficients);
    surface.thickness = to.thickness_mm.value_or(surface.thickness);
    surface.material = to.material.value_or(surface.material);
    surface.clear_semi_diameter = to.clear_semi_diameter_mm.value_or(surface.clear_semi_diameter);
    surface.inner_semi_diameter = to.inner_semi_diameter_mm.value_or(surface.inner_semi_diameter);
    surface.conic = to.conic.value_or(surface.conic);
    surface.coating = to.coating.value_or(surface.coating);
    if (to.decentre_mm) surface.placement.decentre = triple_from(*to.decentre_mm, 2, "decentre_mm");
    if (to.tilt_deg) surface.placement.tilt_deg = triple_from(*to.tilt_deg, 3, "tilt_deg");
    surface.placement.returns = to.returns.value_or(surface.placement.returns);
    change_form(surface, to.form);
    return surface;
}

using Number = std::optional<double>;
using Numbers = std::optional<std::vector<double>>;
using Name = std::optional<std::string>;
using Dict = std::optional<py::dict>;
using Dicts = std::optional<std::vector<py::dict>>;
using RadialTerms = std::optional<std::map<int, double>>;
using XyTerms = std::optional<std::map<std::pair<int, int>, double>>;

Surface make_surface(double radius_of_curvature, double thickness, const py::object& material,
                     double clear_semi_diameter, double conic, const std::map<int, double>& aspheric,
                     double inner_semi_diameter, const std::string& type, const py::object& coating,
                     const std::vector<double>& decentre, const std::vector<double>& tilt, bool returns,
                     const Name& form, Number radius_x, Number conic_x, const RadialTerms& radial, const XyTerms& xy,
                     const Dict& zernike, const Dict& forbes, const Dict& aperture, const Dicts& obscurations) {
    return changed(Surface(), {radius_of_curvature,
                               thickness,
                               glass_from(material),
                               clear_semi_diameter,
                               conic,
                               aspheric,
                               inner_semi_diameter,
                               type,
                               coating_from(coating),
                               decentre,
                               tilt,
                               returns,
                               {form, radius_x, conic_x, radial, xy, zernike, forbes, aperture, obscurations}});
}

/// Defines a method whose arguments are `first`, and by their names those of Surface. What is left out stays; because
/// None is air, a material that stays is `...`.
template <class>
using Index = int;
template <class T, class Function, class... First>
void def_surface_changes(py::class_<T>& type, const char* name, Function function, const char* text, First... first) {
    type.def(
        name,
        [function](const T& self, Index<First>... place, Number radius, Number thickness, const py::object& material,
                   Number clear, Number conic, const RadialTerms& aspheric, Number inner, const Name& surface_type,
                   const py::object& coating, const Numbers& decentre, const Numbers& tilt, std::optional<bool> returns,
                   const Name& form, Number radius_x, Number conic_x, const RadialTerms& radial, const XyTerms& xy,
                   const Dict& zernike, const Dict& forbes, const Dict& aperture, const Dicts& obscurations) {
            const bool stays = material.is(py::ellipsis());
            const SurfaceChanges changes{
                radius,
                thickness,
                stays ? std::nullopt : std::optional(glass_from(material)),
                clear,
                conic,
                aspheric,
                inner,
                surface_type,
                coating.is_none() ? std::nullopt : std::optional(coating_from(coating)),
                decentre,
                tilt,
                returns,
                {form, radius_x, conic_x, radial, xy, zernike, forbes, aperture, obscurations}};
            return function(self, place..., changes);
        },
        first..., py::kw_only(), "radius_of_curvature_mm"_a = py::none(), "thickness_mm"_a = py::none(),
        "material"_a = py::ellipsis(), "clear_semi_diameter_mm"_a = py::none(), "conic"_a = py::none(),
        "aspheric_coefficients"_a = py::none(), "inner_semi_diameter_mm"_a = py::none(), "type"_a = py::none(),
        "coating"_a = py::none(), "decentre_mm"_a = py::none(), "tilt_deg"_a = py::none(), "returns"_a = py::none(),
        "form"_a = py::none(), "radius_of_curvature_x_mm"_a = py::none(), "conic_x"_a = py::none(),
        "radial_terms"_a = py::none(), "xy_terms"_a = py::none(), "zernike"_a = py::none(), "forbes"_a = py::none(),
        "aperture"_a = py::none(), "obscurations"_a = py::none(), text);
}

std::map<int, double> aspheric_map(const Surface& surface) {
    std::map<int, double> map;
    for (std::size_t i = 0; i < surface.aspheric.size(); ++i)
        if (surface.aspheric[i] != 0) map[4 + 2 * static_cast<int>(i)] = surface.aspheric[i];
    return map;
}

LensSystem make_lens(std::vector<Surface> surfaces, const std::string& name, std::optional<double> film_distance,
                     std::pair<double, double> film, double wavelength_nm, int blades, double rounding,
                     double rotation_deg, std::optional<std::pair<int, int>> focus_group, double nearest_focus_m,
                     bool allow_crossing, double film_radius_of_curvature) {
    LensSystem lens;
    lens.allow_crossing = allow_crossing;
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

std::string text_of(const Glass& glass) {
    return glass.label.empty() ? glass.is_air() ? "air" : "index " + digits(glass.index(kLineD_nm))
                               : shortened(glass.label);
}

std::string text_of(const Surface& s) {
    std::string text = std::string("<realcam.Surface ") + kTypeNames[static_cast<int>(s.type)];
    if (s.curvature != 0) text += ", radius " + digits(1 / s.curvature) + " mm";
    text += ", semi-diameter " + digits(s.clear_semi_diameter) + " mm";
    if (s.is_asphere() || s.conic != 0) text += ", aspheric";
    if (const std::string why = s.form.asymmetry(); !why.empty()) text += ", " + why;
    if (s.placement.tilt_deg != Vec3d{0, 0, 0}) text += ", tilted";
    if (s.placement.decentre != Vec3d{0, 0, 0}) text += ", decentred";
    if (s.coating.kind != CoatingKind::unknown)
        text += ", " + (s.coating.name.empty() ? std::string("coated") : shortened(s.coating.name));
    return text + ", then " + digits(s.thickness) + " mm of " + text_of(s.material) + '>';
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

/// (N, 4, 3).
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

std::string text_of(const FirstOrder& data) {
    return "<realcam.FirstOrder focal length " + digits(data.effective_focal_length) + " mm, f/" +
           digits(data.f_number) + ", back focal distance " + digits(data.back_focal_distance) + " mm>";
}

std::optional<std::pair<int, int>> focus_group_of(const LensSystem& lens) {
    if (!lens.focusing.moves_group()) return std::nullopt;
    return std::pair(lens.focusing.group_first, lens.focusing.group_last);
}

void warn(const std::string& message) {
    // On the line of the user's call.
    if (PyErr_WarnEx(PyExc_UserWarning, message.c_str(), 1) < 0) throw py::error_already_set();
}

/// The lens of a file, and notes on what was computed or assumed. Other threads run meanwhile, and Ctrl-C ends it.
std::pair<LensSystem, std::vector<std::string>> read_unlocked(const std::string& path, io::LensReadOptions options) {
    std::vector<std::string> notes;
    options.warn = [&](const std::string& note) { notes.push_back(note); };
    options.keep_going = heed_signals;
    const Unlocked unlocked;
    LensSystem lens = io::read_lens(path, options);
    return {std::move(lens), std::move(notes)};
}

LensSystem load_lens(const py::object& name, const std::optional<std::map<std::string, py::object>>& glass, bool force,
                     const std::optional<std::string>& pbrt_thickness) {
    io::LensReadOptions options;
    options.force = force;
    if (glass)
        for (const auto& [called, material] : *glass) options.glasses.insert_or_assign(called, glass_from(material));
    if (pbrt_thickness) options.pbrt_thickness = io::pbrt_thickness_named(*pbrt_thickness);
    auto [lens, notes] = read_unlocked(path_from(name), std::move(options));
    for (const std::string& note : notes) warn(note);
    return std::move(lens);
}

std::pair<LensSystem, std::vector<std::string>> read_lens_with_notes(const py::object& path) {
    return read_unlocked(path_from(path), {});
}

/// The content of its file, and what a file with that suffix cannot say.
std::pair<py::bytes, std::vector<std::string>> file_content(const LensSystem& lens, const py::object& path) {
    const std::string file = path_from(path);
    if (io::suffix_of(file) == ".OSL")
        return {py::module_::import("realcam.osl").attr("shader_text")(lens).attr("encode")(), {}};
    io::LensText text = io::lens_text_for(lens, file);
    return {py::bytes(text.text), std::move(text.warnings)};
}

void save_lens(const LensSystem& lens, const py::object& path) {
    const py::module_ files = py::module_::import("realcam.files");
    files.attr("check_target")(path);
    const auto [content, warnings] = file_content(lens, path);
    files.attr("write_whole")(path, content);
    for (const std::string& left_out : warnings) warn("not in the file: " + left_out);
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

/// A whole number is a position's index, as in Python, where 1 and 1.0 are different things.
LensSystem zoomed_to(const LensSystem& lens, const std::variant<std::string, int, double>& to) {
    if (const double* focal_length_mm = std::get_if<double>(&to)) return zoomed_to_focal_length(lens, *focal_length_mm);
    if (const int* position = std::get_if<int>(&to)) return zoomed(lens, *position);
    return zoomed(lens, std::get<std::string>(to));
}

void bind_glass(py::module_& m) {
    py::class_<Glass> glass(m, "Glass", "An optical medium: refractive index relative to air, by wavelength.");
    def_hashable_value(glass);
    glass
        .def_static(
            "constant",
            [](double index) {
                if (!(index >= 1) || !std::isfinite(index))
                    throw InputError("a refractive index of at least 1 is wanted");
                return Glass::constant(index);
            },
            "index"_a, "The same index at every wavelength.")
        .def_static(
            "from_abbe_number", &Glass::from_abbe_number, "n_d"_a, "abbe_number"_a,
            "Two-term Cauchy glass with this index at the d line and this Abbe number V_d = (n_d - 1)/(n_F - n_C).\n"
            "Raises InputError for an index below 1 or a number that is not positive.")
        .def_static("cauchy", &Glass::cauchy, "coefficients"_a,
                    "n = A + B/l^2 + C/l^4 + ..., l in um. Raises InputError where there is no coefficient.")
        .def_static(
            "sellmeier",
            [](const std::vector<double>& b, const std::vector<double>& c) {
                if (b.size() != c.size() || b.empty()) throw InputError("sellmeier needs equally many B and C");
                std::vector<Glass::SellmeierTerm> terms;
                for (std::size_t i = 0; i < b.size(); ++i) terms.push_back({b[i], c[i]});
                return Glass::sellmeier(terms);
            },
            "B"_a, "C"_a, "n^2 = 1 + sum B l^2/(l^2 - C), l in um, C in um^2.")
        .def_static(
            "table",
            [](const std::vector<std::pair<double, double>>& points) {
                std::vector<Glass::TablePoint> list;
                for (const auto& [wavelength, index] : points) list.push_back({wavelength, index});
                return Glass::table(std::move(list));
            },
            "points"_a, "Interpolated (wavelength_nm, index) pairs.")
        .def_static("named", &io::catalogue_glass, "name"_a,
                    "A glass of the catalogue, \"N-BK7\" or \"schott:F4\". Raises InputError with the nearest names.")
        .def("index", &Glass::index, "wavelength_nm"_a, "Refractive index.")
        .def_readonly("label", &Glass::label, "As it was written: a name, a number, a pair; empty for air.")
        .def("__repr__", [](const Glass& g) { return "<realcam.Glass " + text_of(g) + '>'; });
}

void bind_surface(py::module_& m) {
    py::class_<Surface> surface(
        m, "Surface",
        "One row of a lens table: a surface and what lies behind it. Lengths in mm, lens frame (z to the film).");
    def_hashable_value(surface);
    surface
        .def(py::init(&make_surface), py::kw_only(), "radius_of_curvature_mm"_a = kInfinity, "thickness_mm"_a = 0.0,
             "material"_a = py::none(), "clear_semi_diameter_mm"_a, "conic"_a = 0.0,
             "aspheric_coefficients"_a = std::map<int, double>{}, "inner_semi_diameter_mm"_a = 0.0,
             "type"_a = "refracting", "coating"_a = "unknown", "decentre_mm"_a = std::vector<double>{0, 0, 0},
             "tilt_deg"_a = std::vector<double>{0, 0, 0}, "returns"_a = false, "form"_a = py::none(),
             "radius_of_curvature_x_mm"_a = py::none(), "conic_x"_a = py::none(), "radial_terms"_a = py::none(),
             "xy_terms"_a = py::none(), "zernike"_a = py::none(), "forbes"_a = py::none(), "aperture"_a = py::none(),
             "obscurations"_a = py::none(),
             "radius_of_curvature_mm: positive where the centre lies on the film side; inf: plane.\n"
             "thickness_mm: to the next surface; that of the last surface is not used.\n"
             "material: behind the surface: index, (n_d, V_d), glass name, Glass, or None for air.\n"
             "conic: k = -e^2. aspheric_coefficients: {even power of r: mm^(1 - power)}, powers 4 to 18.\n"
             "inner_semi_diameter_mm: light closer to the axis is blocked.\n"
             "type: refracting, mirror, stop or aperture (a plane that only blocks).\n"
             "coating: \"bare\", \"quarter_wave\", of a mirror \"aluminium\" or \"silver\", a Coating, or \"unknown\": "
             "light\n"
             "is then taken to meet bare glass, or a perfect mirror.\n"
             "decentre_mm: (x, y) or (x, y, z) of the vertex, from its place on the axis. tilt_deg: angles by which "
             "it\n"
             "is then turned about x, its new y and its new z, counterclockwise as seen from the axis's tip. returns:\n"
             "this moves the surface alone; else the axis goes on from there, with all that follows and the film.\n"
             "form: \"biconic\" or \"toroid\", of which radius and conic are the section in the yz plane, and\n"
             "radius_of_curvature_x_mm and conic_x that in the xz plane. A toroid's even terms are of y.\n"
             "radial_terms: {power of r: mm^(1 - power)}, powers 1 to 20. xy_terms: {(i, j): coefficient of x^i y^j}.\n"
             "zernike: {\"order\": \"noll\" or \"fringe\", \"radius_mm\", \"coefficients_mm\"}. forbes: the same "
             "with\n"
             "\"kind\": \"bfs\" or \"con\". These parts are added to the conic.\n"
             "aperture: {\"ellipse_mm\" or \"rectangle_mm\": (half_x, half_y)}, {\"circle_mm\": radius} or\n"
             "{\"polygon_mm\": corners}, each with \"offset_mm\". obscurations: a list of {\"circle_mm\", "
             "\"ellipse_mm\" or\n"
             "\"rectangle_mm\", \"offset_mm\", \"angle_deg\"} and {\"spider_arms\": count, \"width_mm\", "
             "\"angle_deg\"}.")
        .def_property_readonly("radius_of_curvature_mm",
                               [](const Surface& s) { return s.curvature == 0 ? kInfinity : 1 / s.curvature; })
        .def_readonly("curvature_per_mm", &Surface::curvature)
        .def_readonly("thickness_mm", &Surface::thickness)
        .def_readonly("material", &Surface::material)
        .def_readonly("clear_semi_diameter_mm", &Surface::clear_semi_diameter)
        .def_readonly("inner_semi_diameter_mm", &Surface::inner_semi_diameter)
        .def_readonly("conic", &Surface::conic)
        .def_property_readonly("aspheric_coefficients", &aspheric_map)
        .def_property_readonly("type", [](const Surface& s) { return kTypeNames[static_cast<int>(s.type)]; })
        .def_readonly("coating", &Surface::coating)
        .def_property_readonly("decentre_mm", [](const Surface& s) { return triple(s.placement.decentre); })
        .def_property_readonly("tilt_deg", [](const Surface& s) { return triple(s.placement.tilt_deg); })
        .def_property_readonly("returns", [](const Surface& s) { return s.placement.returns; })
        .def_property_readonly("form", &form_name)
        .def_property_readonly(
            "radius_of_curvature_x_mm",
            [](const Surface& s) { return s.form.curvature_x == 0 ? kInfinity : 1 / s.form.curvature_x; })
        .def_property_readonly("conic_x", [](const Surface& s) { return s.form.conic_x; })
        .def_property_readonly("radial_terms", &radial_terms_of)
        .def_property_readonly("xy_terms", &xy_terms_of)
        .def_property_readonly("zernike", &zernike_of)
        .def_property_readonly("forbes", &forbes_of)
        .def_property_readonly("aperture", &aperture_of)
        .def_property_readonly("obscurations", &obscurations_of)
        .def(
            "sag_mm", [](const Surface& s, double radius) { return s.sag(radius); }, "radius_mm"_a,
            "Height over the vertex plane at a distance from the axis, in the yz plane; nan past the edge of the "
            "conic.")
        .def(
            "sag_at_mm", [](const Surface& s, double x, double y) { return s.sag(x, y); }, "x_mm"_a, "y_mm"_a,
            "Height over the vertex plane; nan past the edge of the conic.")
        .def("__repr__", [](const Surface& s) { return text_of(s); });
    def_surface_changes(surface, "replace", &changed,
                        "The surface with some of what Surface() takes changed. What is not given stays.");
}

void bind_first_order(py::module_& m) {
    py::class_<FirstOrder> data(
        m, "FirstOrder",
        "First-order data at one wavelength. mm; positions from the front vertex. Of an afocal lens the focal length,\n"
        "the focal distances and the f-number are infinite.");
    def_hashable_value(data);
    data.def_readonly("effective_focal_length_mm", &FirstOrder::effective_focal_length)
        .def_readonly("back_focal_distance_mm", &FirstOrder::back_focal_distance)
        .def_readonly("front_focal_distance_mm", &FirstOrder::front_focal_distance)
        .def_readonly("f_number", &FirstOrder::f_number)
        .def_readonly("entrance_pupil_position_mm", &FirstOrder::entrance_pupil_position)
        .def_readonly("entrance_pupil_diameter_mm", &FirstOrder::entrance_pupil_diameter)
        .def_readonly("exit_pupil_position_mm", &FirstOrder::exit_pupil_position)
        .def_readonly("exit_pupil_diameter_mm", &FirstOrder::exit_pupil_diameter)
        .def("__repr__", [](const FirstOrder& d) { return text_of(d); });
    py::class_<Meridian> meridian(
        m, "Meridian",
        "A lens in one of its two principal meridians: planes through the chief ray of the film's middle in which\n"
        "light stays. mm; without power the focal length and the f-number are infinite.");
    def_hashable_value(meridian);
    meridian
        .def_readonly("azimuth_deg", &Meridian::azimuth_deg,
                      "Of the plane in front of the lens, from the x axis towards y; -90 to 90.")
        .def_readonly("focal_length_mm", &Meridian::focal_length)
        .def_readonly("back_focal_distance_mm", &Meridian::back_focal_distance,
                      "Last vertex to the focus of distant light.")
        .def_readonly("f_number", &Meridian::f_number)
        .def_readonly("entrance_pupil_diameter_mm", &Meridian::entrance_pupil_diameter)
        .def("__repr__", [](const Meridian& d) {
            return "<realcam.Meridian at " + digits(d.azimuth_deg) + " deg, focal length " + digits(d.focal_length) +
                   " mm, f/" + digits(d.f_number) + '>';
        });
}

}  // namespace

void bind_lens(py::module_& m) {
    bind_glass(m);
    bind_surface(m);
    bind_first_order(m);
    m.def("lens_names", &io::lens_names, "Names of the bundled lenses.");
    m.def("glass_names", &io::catalogue_full_names, "Names of the glasses of the catalogue, as \"schott:N-BK7\".");
    py::class_<LensSystem> lens_class(m, "Lens",
                                      "A lens in one state of its rings. A value: every change returns a new Lens.");
    def_hashable_value(lens_class);
    lens_class
        .def(py::init(&make_lens), py::kw_only(), "surfaces"_a, "name"_a = "", "film_distance_mm"_a = py::none(),
             "film_mm"_a = std::pair<double, double>{36, 24}, "wavelength_nm"_a = kLineD_nm, "iris_blades"_a = 0,
             "iris_rounding"_a = 0.0, "iris_rotation_deg"_a = 0.0, "focus_group"_a = py::none(),
             "nearest_focus_m"_a = 0.0, "allow_crossing"_a = false, "film_radius_of_curvature_mm"_a = kInfinity,
             "surfaces: from the scene to the film, exactly one of them a Stop.\n"
             "film_distance_mm: last vertex to film; None: best focus at infinity by real rays.\n"
             "film_mm: (width, height) used where a Camera names no film.\n"
             "iris_blades: 0 for a round diaphragm, else 3 to 24; iris_rounding: 0 straight to 1 a circle.\n"
             "focus_group: (first, last) index of the surfaces that move to focus; None: the whole lens moves.\n"
             "allow_crossing: for experiments, faces may cross inside their rims, and the film the last face.\n"
             "film_radius_of_curvature_mm: below 0 the film is hollow towards the lens; inf: flat.\n"
             "Raises LensFileError, naming the surface (from 1), where the lens cannot be built.")
        .def_static(
            "load", &load_lens, "name_or_path"_a, py::kw_only(), "glass"_a = py::none(), "force"_a = false,
            "pbrt_thickness"_a = py::none(),
            "A bundled lens by name, or a lens file by path. The suffix says of which program: .zmx (Zemax), "
            ".seq\n"
            "(CODE V), .len (OSLO), .dat (pbrt), .json (Optiland), .roa (ray-optics); else it is realcam's own, TOML.\n"
            "glass: {name in the file: (n_d, V_d), \"schott:F4\", or what else Surface() takes}, for glasses that "
            "no\n"
            "catalogue has, or several. force: leaves out what realcam has no model of, with a UserWarning.\n"
            "pbrt_thickness: \"after\" or \"before\" the surface of its row; None: the first row tells.\n"
            "Raises LensFileError with file, line and surface, and InputError where glass names one that the\n"
            "file does not have. What a file leaves out and is computed or assumed is a UserWarning.")
        .def("save", &save_lens, "path"_a,
             "Writes a lens file by its suffix: .toml, from which Lens.load makes an equal lens; .zmx, .seq, .json\n"
             "(Optiland) or .roa (ray-optics), with a UserWarning for all that these cannot say; .osl, a camera of "
             "Blender\n"
             "5. Raises InputError, also for a lens that OSL cannot express, and ImageFileError where no file can be\n"
             "made.")
        .def_static("_load_with_notes", &read_lens_with_notes, "path"_a)
        .def("_file_content", &file_content, "path"_a)
        .def_property_readonly("zoom_positions", &zoom_position_names,
                               "Names of the zoom positions; empty: the focal length is fixed.")
        .def_property_readonly("zoom_position", &zoom_position_of,
                               "The current one, or the nearest to it; None: the lens does not zoom.")
        .def_property_readonly("zoom_focal_lengths_mm", &zoom_focal_lengths,
                               "Of the lens at rest in each of its zoom positions.")
        .def("zoomed", &zoomed_to, "position"_a,
             "The lens in another zoom position: its name, its index, or, as a float, a focal length in mm between\n"
             "those of the positions. The plane in focus stays, an open diaphragm stays open, and a closed one keeps\n"
             "its f-number as far as it opens. Between positions, spacings lie on monotone cubics over the logarithm\n"
             "of the focal length, which is that of the lens at rest. Raises InputError.")
        .def(
            "first_order",
            [](const LensSystem& lens, std::optional<double> nm) {
                return first_order(lens, wavelength_or_design(lens, nm));
            },
            "wavelength_nm"_a = py::none(),
            "At the design wavelength where none is given. Of a lens that is no centred one of revolution: about the\n"
            "chief ray of the film's middle, the means of both meridians, so that the f-number is that of the "
            "exposure.\n"
            "How the whole lens is tilted or shifted before the film changes nothing. Raises InputError where the "
            "film's\n"
            "middle gets no light.")
        .def(
            "meridians",
            [](const LensSystem& lens, std::optional<double> nm) {
                const ParabasalData data = parabasal_data(lens, wavelength_or_design(lens, nm));
                return std::pair(data.meridians[0], data.meridians[1]);
            },
            "wavelength_nm"_a = py::none(),
            "First-order data in the two principal meridians, about the chief ray of the film's middle; that nearer "
            "to\n"
            "the x axis first. Raises InputError where there is no such ray.")
        .def(
            "focused", [](const LensSystem& lens, double metres) { return focused(lens, 1000 * metres); },
            "focus_distance_m"_a,
            "The lens focused on a plane at this distance from the film, inf allowed: the real rays of the full "
            "aperture\n"
            "make their smallest spot. Raises InputError where the lens cannot.")
        .def("stopped_down", &stopped_down, "f_number"_a,
             "The lens with its diaphragm closed to an f-number: that of the lens focused at infinity, as it is "
             "engraved,\n"
             "whatever the lens is focused on. Raises InputError where it does not open that far.")
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
        .def_readonly("allow_crossing", &LensSystem::allow_crossing)
        .def(
            "crossings",
            [](const LensSystem& lens) {
                std::vector<std::tuple<int, int, double, double>> list;
                for (const FaceCrossing& c : find_crossings(lens))
                    list.emplace_back(c.first, c.second, c.depth, c.radius);
                return list;
            },
            "Pairs of faces that cross inside their rims, as (first, second, depth_mm, radius_mm): the indices of the "
            "two,\n"
            "how far they reach into each other at most, and how far from the axis that is. Empty but with "
            "allow_crossing.")
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
            "film_frame", [](const LensSystem& l) { return py::array(frames_array({film_frame(l)})[py::int_(0)]); },
            "(4, 3): x, y and z axis of the film and its middle in mm, lens frame. Light comes with growing z.")
        .def_property_readonly("focus_distance_m", [](const LensSystem& l) { return l.focus_distance / 1000; })
        .def_property_readonly("nearest_focus_m", [](const LensSystem& l) { return l.focusing.nearest_mm / 1000; })
        .def_property_readonly("stop_index", &LensSystem::stop_index)
        .def_readonly("stop_semi_diameter_mm", &LensSystem::stop_semi_diameter)
        .def_property_readonly("is_rotational", &LensSystem::is_rotational,
                               "Whether this is a centred lens of revolution: no surface is tilted or decentred.")
        .def_property_readonly("iris_blades", [](const LensSystem& l) { return l.iris.blades; })
        .def(
            "with_iris",
            [](const LensSystem& lens, int blades, std::optional<double> rounding, std::optional<double> rotation_deg) {
                const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
                return with_iris(lens, {blades, rounding.value_or(lens.iris.rounding),
                                        rotation_deg ? radians(*rotation_deg) : lens.iris.rotation_rad});
            },
            "blades"_a, "rounding"_a = py::none(), "rotation_deg"_a = py::none(),
            "The lens with another diaphragm: blades, rounding and rotation as Lens() takes them; None stays. The\n"
            "f-number stays too, because it is the open area that it means. Raises LensFileError.")
        .def(
            "with_coating",
            [](const LensSystem& lens, const py::object& coating, const std::optional<std::vector<int>>& surfaces) {
                return surfaces ? with_coating(lens, coating_from(coating), *surfaces)
                                : with_coating(lens, coating_from(coating));
            },
            "coating"_a, "surfaces"_a = py::none(),
            "The lens with another coating, as Surface() takes it, on the surfaces of these indices; None: on all that "
            "it "
            "is\n"
            "for, a mirror's on all mirrors, any other on all faces between air and glass. Cemented faces stay as they "
            "are.\n"
            "Raises InputError, and LensFileError where a coating does not fit its surface.")
        .def_property_readonly("iris_rounding", [](const LensSystem& l) { return l.iris.rounding; })
        .def_property_readonly("iris_rotation_deg",
                               [](const LensSystem& l) { return l.iris.rotation_rad * 180 / std::numbers::pi; })
        .def_property_readonly("focus_group", &focus_group_of, "(first, last) index; None: the whole lens moves.")
        .def("__repr__", [](const LensSystem& l) { return text_of(l); });
    def_surface_changes(
        lens_class, "with_surface",
        [](const LensSystem& lens, int index, const SurfaceChanges& changes) {
            const bool exists = index >= 0 && index < static_cast<int>(lens.surfaces.size());
            return with_surface(lens, index,
                                exists ? changed(lens.surfaces[static_cast<std::size_t>(index)], changes) : Surface());
        },
        "The lens with one surface changed: its index from 0, as in surfaces, and what Surface() takes. What is not\n"
        "given stays; so do focus group, iris, film and title, and the film where it is: focused() brings the picture\n"
        "into focus again. Raises InputError, and LensFileError where the lens cannot be built.",
        "index"_a);
}

}  // namespace realcam::bindings
