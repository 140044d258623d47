#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <variant>

#include "../scene/scene_checks.hpp"
#include "material.hpp"
#include "short_text.hpp"
#include "value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Colour = std::array<float, 3>;
using Which = std::variant<py::ssize_t, py::str>;

Vec3f rgb(const Colour& c) {
    return {c[0], c[1], c[2]};
}

auto colour_of(Vec3f Material::* member) {
    return [member](const PythonMaterial& m) {
        const Vec3f c = m.values.*member;
        return py::make_tuple(c.x, c.y, c.z);
    };
}

/// None: no texture.
std::shared_ptr<const Texture> texture_or_none(const py::object& pixels) {
    return pixels.is_none() ? nullptr : texture_from(pixels);
}

PythonMaterial make_material(const Colour& diffuse, const Colour& specular, float shininess, const Colour& emission,
                             const py::object& texture, const std::string& name) {
    return {name, {rgb(diffuse), rgb(specular), shininess, rgb(emission), -1}, texture_or_none(texture)};
}

PythonMaterial changed(PythonMaterial m, const std::optional<Colour>& diffuse, const std::optional<Colour>& specular,
                       std::optional<float> shininess, const std::optional<Colour>& emission, const py::object& texture,
                       const std::optional<std::string>& name) {
    if (diffuse) m.values.diffuse = rgb(*diffuse);
    if (specular) m.values.specular = rgb(*specular);
    if (emission) m.values.emission = rgb(*emission);
    m.values.shininess = shininess.value_or(m.values.shininess);
    m.name = name.value_or(m.name);
    if (!texture.is(py::ellipsis())) m.texture = texture_or_none(texture);
    return m;
}

/// Without a copy, and not to be written to.
py::object texture_array(const PythonMaterial& material) {
    if (!material.texture) return py::none();
    using Owner = std::shared_ptr<const Texture>;
    const Texture& texture = *material.texture;
    const py::capsule owner(new Owner(material.texture), [](void* p) { delete static_cast<Owner*>(p); });
    py::array_t<std::uint8_t> array({texture.height, texture.width, 4}, texture.rgba.data(), owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

std::string text_of(const PythonMaterial& material) {
    const Material& m = material.values;
    const Vec3f black = {0, 0, 0};
    std::string text = "<realcam.Material" + (material.name.empty() ? "" : ' ' + shortened(material.name) + ',') +
                       " diffuse " + point_text(m.diffuse);
    if (m.specular != black)
        text += ", specular " + point_text(m.specular) + " ^ " + digits(static_cast<double>(m.shininess));
    if (m.emission != black) text += ", emission " + point_text(m.emission);
    if (material.texture)
        text +=
            ", texture " + std::to_string(material.texture->width) + " x " + std::to_string(material.texture->height);
    return text + '>';
}

/// Of what was unpickled; the rest is checked with the scene.
void check(const PythonMaterial& material) {
    if (!material.texture) return;
    const Texture& t = *material.texture;
    if (t.width < 1 || t.height < 1 ||
        t.rgba.size() != std::size_t{4} * static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height))
        throw InputError("the texture of a pickled material is damaged");
}

// A scene's materials.

py::dict materials_of(const Assembly& scene) {
    py::dict materials;
    const std::vector<std::string> names = material_names(*scene.static_geometry);
    for (std::size_t i = 0; i < names.size(); ++i)
        materials[text_from(names[i])] = material_of(scene.static_geometry, i);
    return materials;
}

std::size_t find_material(const Assembly& scene, const Which& which) {
    const std::vector<std::string> names = material_names(*scene.static_geometry);
    std::string all;
    for (const std::string& name : names)
        if (all.size() < 200) all += (all.empty() ? "\"" : ", \"") + name + '"';
    if (const auto* name = std::get_if<py::str>(&which)) {
        for (std::size_t i = 0; i < names.size(); ++i)
            if (text_from(names[i]).equal(*name)) return i;
        throw InputError("there is no material " + py::repr(*name).cast<std::string>() + "; the scene has " + all);
    }
    const auto number = std::get<py::ssize_t>(which);
    if (number >= 0 && static_cast<std::size_t>(number) < names.size()) return static_cast<std::size_t>(number);
    throw InputError("there is no material " + std::to_string(number) + "; the scene has " +
                     std::to_string(names.size()) + " (counted from 0)");
}

Assembly with_material(const Assembly& scene, const Which& which, const PythonMaterial& material) {
    const std::size_t index = find_material(scene, which);
    const Assembly changed_scene =
        with_static_geometry(scene, [&](Scene& changed) { set_material(changed, index, material); });
    validate(*changed_scene.static_geometry, {}, !changed_scene.instances.empty());
    return changed_scene;
}

Assembly with_texture(const Assembly& scene, const Which& which, const py::object& pixels) {
    PythonMaterial material = material_of(scene.static_geometry, find_material(scene, which));
    material.texture = texture_from(pixels);
    return with_material(scene, which, material);
}

}  // namespace

void bind_material(py::module_& m) {
    py::class_<PythonMaterial> material(m, "Material",
                                        "How a surface reflects and emits light. Colours are linear Rec. 709.");
    def_hashable_value(material, &check);
    material
        .def(
            py::init(&make_material), py::kw_only(), "diffuse"_a = Colour{0.5f, 0.5f, 0.5f},
            "specular"_a = Colour{0, 0, 0}, "shininess"_a = 0.0f, "emission"_a = Colour{0, 0, 0},
            "texture"_a = py::none(), "name"_a = "",
            "diffuse, specular: reflectance of Lambert's and of Phong's lobe; shininess: Phong exponent;\n"
            "emission: radiance in cd/m^2, on the side from which the corners run counter-clockwise;\n"
            "texture: what diffuse is multiplied by, (H, W) grey, (H, W, 3) or (H, W, 4), sRGB codes, row 0 at v = 1:\n"
            "whole numbers from 0 to 255, or fractions from 0 to 1 that are rounded to such codes. Colours are taken\n"
            "as they are, whatever the fourth channel (alpha) says. name: to find it by in Scene.materials.\n"
            "Raises InputError.")
        .def("replace", &changed, py::kw_only(), "diffuse"_a = py::none(), "specular"_a = py::none(),
             "shininess"_a = py::none(), "emission"_a = py::none(), "texture"_a = py::ellipsis(), "name"_a = py::none(),
             "The material with some of what Material() takes changed. What is not given stays; texture=None takes\n"
             "the texture away.")
        .def_property_readonly("diffuse", colour_of(&Material::diffuse))
        .def_property_readonly("specular", colour_of(&Material::specular))
        .def_property_readonly("shininess", [](const PythonMaterial& p) { return p.values.shininess; })
        .def_property_readonly("emission", colour_of(&Material::emission))
        .def_property_readonly("texture", &texture_array, "(H, W, 4) uint8, read-only; None: none.")
        .def_property_readonly("name", [](const PythonMaterial& p) { return text_from(p.name); })
        .def("__repr__", [](const PythonMaterial& p) { return text_from(text_of(p)); });
}

void bind_scene_materials(py::class_<Assembly>& scene) {
    scene
        .def_property_readonly(
            "materials", &materials_of,
            "A dict of static geometry's materials by their names, in their order: the file's names, \"material 3\"\n"
            "for one without a name, \"wood.2\" for the second \"wood\".")
        .def("with_material", &with_material, "which"_a, "material"_a,
             "With another material in place of one, by its name in materials or its number from 0; texture included.\n"
             "The place keeps its name. Raises InputError.")
        .def("with_texture", &with_texture, "material"_a, "pixels"_a,
             "With a texture on a material, by its name or number; pixels as in Material(texture=...).\n"
             "Raises InputError, also where the vertices have no texture coordinates.");
}

}  // namespace realcam::bindings
