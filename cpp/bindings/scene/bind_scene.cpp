// The Python class Scene: reading of files, lights and simple properties. Other files of this folder add materials,
// instances and scenes from arrays.

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <tuple>

#include "../../io/scene_file.hpp"
#include "../../scene/geometry/bounding_box.hpp"
#include "../../scene/scene.hpp"
#include "../../scene/scene_checks.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "picture_readers.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns the normalised vector. Throws InputError if it is zero or not finite; `what`: its name, for the message.
Vec3d unit_vector(const char* what, const Triple& direction) {
    const Vec3d d = vector_of(direction);
    const double size = length(d);
    if (!(size > 0) || !std::isfinite(size)) throw InputError(std::string(what) + " must be a finite vector, not zero");
    return (1 / size) * d;
}

Assembly load(const PathLike& path, double scale, const std::vector<std::string>& objects,
              const std::vector<std::string>& variants, const std::string& scene_name) {
    const std::string name = path_from(path);
    const Unlocked unlocked;
    return io::read_scene(name, {scale, objects, heed_signals, variants, scene_name}, picture_readers().texture);
}

/// Returns the scene after change(static geometry), a function of a Scene&. Throws InputError if the result is invalid.
template <class Change>
Assembly with_valid_static_geometry(const Assembly& scene, Change&& change) {
    const Assembly changed = with_static_geometry(scene, change);
    validate(*changed.static_geometry, {}, !changed.instances.empty());
    return changed;
}

/// Converts a number, for all three channels, or (r, g, b). Returns std::nullopt if the object is neither.
std::optional<Color> number_or_color(const py::object& value) {
    try {
        return py::isinstance<py::sequence>(value) || py::isinstance<py::array>(value) ? rgb(value.cast<Colour>())
                                                                                       : grey(value.cast<float>());
    } catch (const py::cast_error&) {
        return std::nullopt;
    }
}

/// Converts the radiance of an environment; see Scene.with_environment. `layer`: of an OpenEXR file, "" for the main
/// image. `warnings` receives the image reader's warnings. Throws InputError and ImageFileError.
Environment environment_from(const py::object& radiance, const std::string& layer, std::vector<std::string>& warnings) {
    if (py::isinstance<py::str>(radiance) || py::hasattr(radiance, "__fspath__"))
        return picture_readers().environment(path_from(radiance), layer, {},
                                             [&](const std::string& warning) { warnings.push_back(warning); });
    if (!layer.empty()) throw InputError("layer requires that the environment is an OpenEXR file");
    Environment environment;
    if (py::isinstance<py::array>(radiance) && radiance.cast<py::array>().ndim() == 3) {
        const auto pixels = radiance.cast<InputArray<float>>();
        if (pixels.shape(2) != 3 || pixels.size() == 0)
            throw InputError("an environment image must be an array of shape (H, W, 3)");
        environment.height = static_cast<std::int32_t>(pixels.shape(0));
        environment.width = static_cast<std::int32_t>(pixels.shape(1));
        const float* data = pixels.data();
        for (py::ssize_t i = 0; i < pixels.size(); i += 3)
            environment.pixels.push_back({data[i], data[i + 1], data[i + 2]});
    } else {
        const std::optional<Color> constant = number_or_color(radiance);
        if (!constant)
            throw InputError(
                "an environment must be a number, (r, g, b), an image of shape (H, W, 3), or the path of one");
        environment.constant = *constant;
    }
    return environment;
}

Assembly with_environment(const Assembly& scene, const Typed<"float | ArrayLike | str | os.PathLike[str]">& radiance,
                          double scale, double rotation_deg, const std::string& layer) {
    return with_valid_static_geometry(scene, [&](Scene& changed) {
        changed.environment =
            realcam::changed(environment_from(radiance, layer, changed.warnings), {scale, rotation_deg});
    });
}

Assembly with_sun(const Assembly& scene, const Triple& direction, const Colour& illuminance) {
    const Vec3d d = unit_vector("the sun's direction", direction);
    return with_valid_static_geometry(
        scene, [&](Scene& changed) { changed.suns.push_back({static_cast<Vec3f>(d), rgb(illuminance)}); });
}

Assembly with_point_light(const Assembly& scene, const Triple& position, const Colour& intensity) {
    return with_valid_static_geometry(
        scene, [&](Scene& changed) { changed.points.push_back({vector_of(position), rgb(intensity)}); });
}

Assembly with_spot_light(const Assembly& scene, const Triple& position, const Triple& direction,
                         const Colour& intensity, double inner_cone_deg, double outer_cone_deg) {
    const Vec3d axis = unit_vector("the spot's direction", direction);
    if (!(inner_cone_deg >= 0 && inner_cone_deg <= outer_cone_deg && outer_cone_deg <= 90))
        throw InputError("expected 0 <= inner_cone_deg <= outer_cone_deg <= 90");
    return with_valid_static_geometry(scene, [&](Scene& changed) {
        changed.points.push_back(
            {vector_of(position), rgb(intensity), axis, kDegree * inner_cone_deg, kDegree * outer_cone_deg});
    });
}

Assembly with_air(const Assembly& scene, const std::optional<double>& visibility_m,
                  const std::optional<Typed<"float | ArrayLike">>& extinction_per_m,
                  const Typed<"float | ArrayLike">& albedo, double anisotropy, const std::optional<double>& margin_m) {
    if (visibility_m && extinction_per_m)
        throw InputError("visibility_m and extinction_per_m exclude each other: both are the extinction");
    const auto color = [](const char* what, const py::object& value) {
        const std::optional<Color> found = number_or_color(value);
        if (!found) throw InputError(std::string(what) + " must be a number or (r, g, b)");
        return *found;
    };
    Air air;
    if (visibility_m) air.extinction = extinction_of_visibility(*visibility_m);
    if (extinction_per_m) air.extinction = color("extinction_per_m", *extinction_per_m);
    air.albedo = color("albedo", albedo);
    air.anisotropy = static_cast<float>(anisotropy);
    air.margin_m = margin_m;
    return with_valid_static_geometry(scene, [&](Scene& changed) { changed.air = air; });
}

using Corner = std::tuple<double, double, double>;

std::pair<Corner, Corner> bounds(const Assembly& scene) {
    const BoundingBox box = bounding_box(scene);
    return {Corner{box.low.x, box.low.y, box.low.z}, Corner{box.high.x, box.high.y, box.high.z}};
}

std::string text_of(const Assembly& scene) {
    std::string text = "<realcam.Scene " + counted(scene.triangle_count(), "triangle") + ", " +
                       counted(scene.static_geometry->materials.size(), "material");
    if (!scene.instances.empty()) text += ", " + counted(scene.instances.size(), "instance");
    return text + (scene.has_light() ? ">" : ", no light>");
}

}  // namespace

void bind_scene(py::module_& m) {
    py::class_<Assembly> scene_class(
        m, "Scene",
        R"(Scene of triangles, materials, lights and instances of other scenes. Metres, right-handed, y up. Immutable:
every change returns a new Scene. Its materials and warnings are those of the static geometry; instanced objects have
their own.)");
    def_value(scene_class);
    scene_class
        .def_static(
            "load", &load, "path"_a, py::kw_only(), "scale"_a = 1.0, "objects"_a = std::vector<std::string>{},
            "variants"_a = std::vector<std::string>{}, "scene_name"_a = "",
            R"(Reads a scene file: .obj (with its .mtl), .gltf, .glb, .ply, or a stage of USD (.usd, .usda, .usdc
or .usdz; realcam[usd]).
scale: metres per unit of the file; for a stage, a factor on its metersPerUnit.
variants: variants of a stage, such as "/Chair{color=red}".
scene_name: name or index of a scene in a glTF file; "": the file's own.
objects: names of nodes (in an OBJ file: of "o" or "g" statements) that become instances, with all their descendants,
  so that moved() can move them. The second of several nodes "car" is called "car.2".
Minor faults of the file are listed in warnings. Only regular files are read. Raises SceneFileError, and
KeyboardInterrupt on Ctrl-C.)")
        .def("with_environment", &with_environment, "radiance"_a, py::kw_only(), "scale"_a = 1.0,
             "rotation_deg"_a = 0.0, "layer"_a = "",
             R"(Returns the scene with another environment light.
radiance: a number or (r, g, b) in cd/m^2, a latitude-longitude image (H, W, 3) (row 0 at the top, its central column
  towards -z), or the path of one (see realcam.read_environment).
scale: factor on the radiance.
rotation_deg: rotation of an image about the vertical, counterclockwise as seen from above; at 90 its central column
  lies towards -x.
layer: layer of an OpenEXR file; "": the main image. Raises InputError and ImageFileError.)")
        .def("with_sun", &with_sun, "direction"_a, "illuminance"_a,
             R"(Returns the scene with an additional sun: parallel light that travels along direction, (x, y, z).
illuminance: (r, g, b) in lux, on a surface perpendicular to the light. Raises InputError.)")
        .def("with_point_light", &with_point_light, "position_m"_a, "intensity"_a,
             R"(Returns the scene with an additional point light. position_m: (x, y, z); intensity: (r, g, b) in cd.
Raises InputError.)")
        .def("with_spot_light", &with_spot_light, "position_m"_a, "direction"_a, "intensity"_a, py::kw_only(),
             "inner_cone_deg"_a = 0.0, "outer_cone_deg"_a = 45.0,
             R"(Returns the scene with an additional spot light, as in glTF's KHR_lights_punctual.
position_m: (x, y, z). direction: (x, y, z), axis of the cone. intensity: (r, g, b) in cd, on the axis.
inner_cone_deg, outer_cone_deg: angles from the axis; the intensity decreases from the inner cone to 0 at the outer one.
Raises InputError.)")
        .def(
            "with_air", &with_air, "visibility_m"_a = py::none(), py::kw_only(), "extinction_per_m"_a = py::none(),
            "albedo"_a = 1.0, "anisotropy"_a = 0.8, "margin_m"_a = py::none(),
            R"(Returns the scene with other air, a homogeneous medium such as fog that fills the space outside of glass.
visibility_m: distance at which a black object has a contrast of 2% against the horizon; the extinction coefficient is
  3.912 / visibility_m (Koschmieder 1924). extinction_per_m: that coefficient instead, a number or (r, g, b), per metre.
  Without both, the air is clear.
albedo: fraction of the extinction that is scattering, a number or (r, g, b), 0 to 1.
anisotropy: mean cosine of the scattering angle in the phase function of Henyey and Greenstein, -0.99 to 0.99.
margin_m: distance by which the air extends beyond the bounding box of the scene's geometry. None: unlimited or, if the
  scene has a sun or an environment, half of the visibility.
Raises InputError. docs/fog.md describes the model.)")
        .def_property_readonly("triangle_count", &Assembly::triangle_count,
                               "Number of triangles of the static geometry and all instances.")
        .def_property_readonly(
            "material_count", [](const Assembly& s) { return s.static_geometry->materials.size(); },
            "Number of materials of the static geometry.")
        .def_property_readonly("has_light", &Assembly::has_light,
                               "True if the scene has an emitter: a light, an emissive material or an environment.")
        .def_property_readonly("bounds_m", &bounds,
                               "Lowest and highest corner (x, y, z) of the bounding box, in metres.")
        .def_property_readonly(
            "warnings", [](const Assembly& s)->Typed<"list[str]", py::list> {
                py::list texts;
                for (const std::string& warning : s.static_geometry->warnings) texts.append(text_from(warning));
                return texts;
            },
            "List of minor faults that the reader found, such as a missing texture.")
        .def("__repr__", [](const Assembly& s) { return text_of(s); });
    bind_scene_arrays(scene_class);
    bind_stages(m);
    bind_instances(scene_class);
    bind_scene_materials(scene_class);
}

}  // namespace realcam::bindings
