#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <variant>

#include "../../scene/scene_checks.hpp"
#include "../values/arrays.hpp"
#include "../values/material.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Which = std::variant<py::ssize_t, py::str>;
using ColourTuple = Typed<"tuple[float, float, float]", py::tuple>;
using TexturePixels = Typed<"NDArray[uint8] | NDArray[float32] | None">;

std::size_t texture_index(TextureReference Material::* wanted) {
    std::size_t i = 0;
    while (kMaterialTextures[i] != wanted) ++i;
    return i;
}

// Conversions between the members of a material and their Python values.

Colour value(const PythonMaterial& m, Color Material::* member) {
    const Color c = m.values.*member;
    return {c.r, c.g, c.b};
}
float value(const PythonMaterial& m, float Material::* member) {
    return m.values.*member;
}
bool value(const PythonMaterial& m, std::int32_t Material::* member) {
    return m.values.*member != 0;
}
bool value(const PythonMaterial& m, FresnelTerm Material::* member) {
    return m.values.*member != FresnelTerm::none;
}
std::string value(const PythonMaterial& m, std::string PythonMaterial::* member) {
    return m.*member;
}
/// Returns a read-only array that shares the texture's memory, or None.
TexturePixels value(const PythonMaterial& m, TextureReference Material::* member) {
    const std::shared_ptr<const Texture>& texture = m.textures[texture_index(member)];
    if (!texture) return TexturePixels(py::none());
    using Owner = std::shared_ptr<const Texture>;
    const py::capsule owner(new Owner(texture), [](void* p) { delete static_cast<Owner*>(p); });
    const std::vector<py::ssize_t> shape = {texture->height, texture->width, 4};
    py::array array = texture->rgba.empty() ? py::array(py::array_t<float>(shape, texture->linear_rgba.data(), owner))
                                            : py::array(py::array_t<std::uint8_t>(shape, texture->rgba.data(), owner));
    array.attr("flags").attr("writeable") = false;
    return array;
}

void set(PythonMaterial& m, Color Material::* member, const Colour& value) {
    m.values.*member = rgb(value);
}
void set(PythonMaterial& m, float Material::* member, float value) {
    m.values.*member = value;
}
void set(PythonMaterial& m, std::int32_t Material::* member, bool value) {
    m.values.*member = value;
}
void set(PythonMaterial& m, FresnelTerm Material::* member, bool value) {
    m.values.*member = value ? FresnelTerm::physical : FresnelTerm::none;
}
void set(PythonMaterial& m, std::string PythonMaterial::* member, const std::string& value) {
    m.*member = value;
}
/// Sets or, for None, removes a texture.
void set(PythonMaterial& m, TextureReference Material::* member, const py::object& pixels) {
    m.textures[texture_index(member)] = pixels.is_none() ? nullptr : texture_from(pixels, io::use_of(member));
    m.values.*member = {};
}

/// Member of a material with its public name. `text`: docstring of the property.
template <class Member>
struct Field {
    const char* name;
    Member member;
    const char* text;

    using Property = decltype(value(std::declval<PythonMaterial>(), std::declval<Member>()));
    using Value = std::conditional_t<std::is_same_v<Property, TexturePixels>, OptionalArrayLike, Property>;
    Field(const char* name, Member member, const char* text = "") : name(name), member(member), text(text) {}
};

/// Returns a function that makes a material from the values of `fields`; all other members are those of `initial`.
template <class... Members>
auto maker(const PythonMaterial& initial, const Field<Members>&... fields) {
    return [initial, ... members = fields.member](const typename Field<Members>::Value&... values) {
        PythonMaterial made = initial;
        (set(made, members, values), ...);
        return made;
    };
}

template <class Member>
void def_property(py::class_<PythonMaterial>& material, const Field<Member>& field) {
    const auto get = [member = field.member](const PythonMaterial& m) {
        if constexpr (std::is_same_v<typename Field<Member>::Value, Colour>)
            return ColourTuple(py::cast(value(m, member)));
        else if constexpr (std::is_same_v<typename Field<Member>::Value, std::string>)
            return text_from(value(m, member));
        else
            return value(m, member);
    };
    material.def_property_readonly(field.name, get, field.text);
}

PythonMaterial with_numbers(PythonMaterial m, const std::optional<Colour>& diffuse,
                            const std::optional<Colour>& specular, std::optional<float> shininess,
                            const std::optional<Colour>& emission,
                            const Typed<"ArrayLike | types.EllipsisType | None">& texture,
                            const std::optional<std::string>& name, std::optional<float> metallic,
                            std::optional<float> roughness, std::optional<float> transmission, std::optional<float> ior,
                            std::optional<float> opacity) {
    if (diffuse) m.values.diffuse = rgb(*diffuse);
    if (specular) m.values.specular = rgb(*specular);
    if (emission) m.values.emission = rgb(*emission);
    m.values.shininess = shininess.value_or(m.values.shininess);
    m.values.metallic = metallic.value_or(m.values.metallic);
    m.values.roughness = roughness.value_or(m.values.roughness);
    m.values.transmission = transmission.value_or(m.values.transmission);
    m.values.ior = ior.value_or(m.values.ior);
    m.values.opacity = opacity.value_or(m.values.opacity);
    m.name = name.value_or(m.name);
    if (!texture.is(py::ellipsis())) set(m, &Material::diffuse_texture, texture);
    return m;
}

std::string text_of(const PythonMaterial& material) {
    const Material& m = material.values;
    const auto number = [](float v) { return digits(static_cast<double>(v)); };
    std::string text = "<realcam.Material" + (material.name.empty() ? "" : ' ' + shortened(material.name) + ',');
    if (m.model == MaterialModel::phong) {
        text += " diffuse " + color_text(m.diffuse);
        if (!is_black(m.specular)) text += ", specular " + color_text(m.specular) + " ^ " + number(m.shininess);
        if (!is_black(m.mirror)) text += ", mirror " + color_text(m.mirror);
    } else {
        text += " base color " + color_text(m.diffuse) + ", metallic " + number(m.metallic) + ", roughness " +
                number(m.roughness);
        if (m.clearcoat > 0) text += ", clearcoat " + number(m.clearcoat);
    }
    if (m.transmission > 0) text += ", transmission " + number(m.transmission) + ", ior " + number(m.ior);
    if (m.only_shadows) text += ", shadow catcher";
    if (m.opacity < 1) text += ", opacity " + number(m.opacity);
    if (!is_black(m.emission)) text += ", emission " + color_text(m.emission);
    if (const auto& texture = material.textures[0])
        text += ", texture " + std::to_string(texture->width) + " x " + std::to_string(texture->height);
    return text + '>';
}

// Materials of a scene.

Typed<"dict[str, Material]", py::dict> materials_of(const Assembly& scene) {
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

Assembly with_texture(const Assembly& scene, const Which& which, const ArrayLike& pixels) {
    PythonMaterial material = material_of(scene.static_geometry, find_material(scene, which));
    material.textures[0] = texture_from(pixels, io::TextureUse::colour);
    material.values.diffuse_texture = {};
    return with_material(scene, which, material);
}

}  // namespace

void bind_material(py::module_& m) {
    py::class_<PythonMaterial> material(m, "Material",
                                        "How a surface reflects and emits light. Colours are linear Rec. 709.");
    def_hashable_value(material);
    using M = Material;
    const std::tuple both{Field{"name", &PythonMaterial::name},
                          Field{"emission", &M::emission},
                          Field{"transmission", &M::transmission},
                          Field{"ior", &M::ior},
                          Field{"absorption", &M::absorption, "Per metre."},
                          Field{"thin", &M::is_thin},
                          Field{"normal_scale", &M::normal_scale},
                          Field{"opacity", &M::opacity},
                          Field{"opacity_cutoff", &M::opacity_cutoff},
                          Field{"double_sided", &M::emits_on_both_sides},
                          Field{"texture", &M::diffuse_texture,
                                "(H, W, 4), read-only: uint8 codes, or float32 of linear light; None: none."},
                          Field{"specular_texture", &M::specular_texture},
                          Field{"emission_texture", &M::emission_texture},
                          Field{"transmission_texture", &M::transmission_texture},
                          Field{"opacity_texture", &M::opacity_texture},
                          Field{"normal_map", &M::normal_texture}};
    const std::tuple phong{
        Field{"diffuse", &M::diffuse, "Reflectance; of metallic_roughness the base colour."},
        Field{"specular", &M::specular, "Reflectance of Phong's lobe; of metallic_roughness the specular_color."},
        Field{"shininess", &M::shininess},
        Field{"mirror", &M::mirror},
        Field{"fresnel", &M::fresnel},
        Field{"filter", &M::filter},
        Field{"shadow_catcher", &M::only_shadows}};
    const std::tuple metallic_roughness{Field{"metallic", &M::metallic},
                                        Field{"roughness", &M::roughness},
                                        Field{"specular_weight", &M::specular_weight},
                                        Field{"clearcoat", &M::clearcoat},
                                        Field{"clearcoat_roughness", &M::clearcoat_roughness},
                                        Field{"clearcoat_normal_scale", &M::clearcoat_normal_scale},
                                        Field{"metallic_roughness_texture", &M::metallic_roughness_texture,
                                              "Of Wavefront's material: the shininess_texture."},
                                        Field{"specular_weight_texture", &M::specular_weight_texture},
                                        Field{"clearcoat_texture", &M::clearcoat_texture},
                                        Field{"clearcoat_roughness_texture", &M::clearcoat_roughness_texture},
                                        Field{"clearcoat_normal_map", &M::clearcoat_normal_texture}};
    // Names that exist only as constructor arguments.
    const std::tuple also_phong{Field{"shininess_texture", &M::metallic_roughness_texture}};
    const std::tuple also_metallic_roughness{Field{"base_color", &M::diffuse}, Field{"specular_color", &M::specular}};
    std::apply([&](const auto&... fields) { (def_property(material, fields), ...); },
               std::tuple_cat(both, phong, metallic_roughness));
    PythonMaterial initial;
    std::apply(
        [&](const auto&... fields) {
            material.def(py::init(maker(initial, fields...)), py::kw_only(),
                         (py::arg(fields.name) = value(initial, fields.member))...,
                         R"(Wavefront's material (MTL). diffuse, specular: reflectance of Lambert's and of Phong's lobe;
shininess: Phong exponent; emission: radiance in cd/m^2, on the side from which the corners run counter-clockwise;
mirror: reflectance as a mirror, at normal incidence; fresnel: whether it grows towards grazing incidence (Schlick),
and a smooth border reflects as its index says; transmission: share of the surface that is a smooth border between
outside and a medium of index ior, which multiplies what passes by filter and absorbs on the way, per metre; thin: a
film, behind which light goes on as it came. texture, specular_texture, emission_texture: what diffuse, specular and
emission are multiplied by, (H, W) grey, (H, W, 3) or (H, W, 4), sRGB codes, row 0 at v = 1: whole numbers from 0 to
255, or fractions from 0 to 1, which are kept as floats. Colours are taken as they are, whatever the fourth channel
(alpha) says. normal_map: directions in tangent space, in the same way but linear; normal_scale: of their x and y.
shininess_texture (its green channel) and transmission_texture (red): what those are multiplied by, linear. name: to
find it by in Scene.materials. opacity, times opacity_texture (its fourth channel, or the mean of fewer, linear):
share of the surface that is there; through the rest light goes as if there were nothing, shadows included. With an
opacity_cutoff above 0 there is all of it where that product reaches the cutoff, and nothing elsewhere.
double_sided: emission leaves on both sides. shadow_catcher: invisible, but what is seen through it is as much
darker as the lights are hidden from it (MTL's illumination model 10); light and shadows go through; it counts as a
bounce. Raises InputError.)");
        },
        std::tuple_cat(phong, also_phong, both));
    initial.values.model = MaterialModel::metallic_roughness;
    initial.values.diffuse = initial.values.specular = {1, 1, 1};
    std::apply(
        [&](const auto&... fields) {
            material.def_static(
                "metallic_roughness", maker(initial, fields...), py::kw_only(),
                (py::arg(fields.name) = value(initial, fields.member))...,
                R"(glTF's material: GGX microfacets of alpha = roughness^2 on a metal, on a dielectric over a diffuse
base, or, for the share transmission of it, on a border that lets light through; all between 0 and 1. base_color,
times texture: the metal's reflectance, the diffuse one, or the tint of what passes. ior: of the dielectric;
specular_color, specular_weight: what its reflection is multiplied by. metallic_roughness_texture: roughness in
green and metallic in blue, linear, times the numbers. clearcoat: share of a second, colourless layer of index 1.5
above all, which has the mesh's normals, or those of clearcoat_normal_map. specular_texture: colours that
specular_color is multiplied by; linear, and of one channel: specular_weight_texture (the fourth, or the mean of
fewer), clearcoat_texture and transmission_texture (red), clearcoat_roughness_texture (green). absorption, thin,
emission, opacity and the other textures as in Material(). Raises InputError.)");
        },
        std::tuple_cat(also_metallic_roughness, metallic_roughness, both));
    material
        .def("replace", &with_numbers, py::kw_only(), "diffuse"_a = py::none(), "specular"_a = py::none(),
             "shininess"_a = py::none(), "emission"_a = py::none(), "texture"_a = py::ellipsis(), "name"_a = py::none(),
             "metallic"_a = py::none(), "roughness"_a = py::none(), "transmission"_a = py::none(), "ior"_a = py::none(),
             "opacity"_a = py::none(),
             R"(The material with some numbers changed. What is not given stays; texture=None takes the texture away;
diffuse is the base colour of a metallic_roughness material, specular its specular_color.)")
        .def_property_readonly(
            "model",
            [](const PythonMaterial& p) {
                return p.values.model == MaterialModel::phong ? "phong" : "metallic_roughness";
            },
            "\"phong\" or \"metallic_roughness\".")
        .def("__repr__", [](const PythonMaterial& p) { return text_from(text_of(p)); });
}

void bind_scene_materials(py::class_<Assembly>& scene) {
    scene
        .def_property_readonly(
            "materials", &materials_of,
            R"(A dict of static geometry's materials by their names, in their order: the file's names, "material 3"
for one without a name, "wood.2" for the second "wood".)")
        .def("with_material", &with_material, "which"_a, "material"_a,
             R"(With another material in place of one, by its name in materials or its number from 0; texture included.
The place keeps its name. Raises InputError.)")
        .def("with_texture", &with_texture, "material"_a, "pixels"_a,
             R"(With a texture on a material, by its name or number; pixels as in Material(texture=...).
Raises InputError, also where the vertices have no texture coordinates.)");
}

}  // namespace realcam::bindings
