// The Python class Material, and the materials of a Scene.

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

using Which = std::variant<py::ssize_t, py::str>;  ///< index or name of a material of a scene
using ColourTuple = Typed<"tuple[float, float, float]", py::tuple>;
using TexturePixels = Typed<"NDArray[uint8] | NDArray[float32] | None">;

/// Returns the index in kMaterialTextures of a texture member.
std::size_t texture_index(TextureReference Material::* member) {
    std::size_t i = 0;
    while (kMaterialTextures[i] != member) ++i;
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

    /// Type of the property, and of the constructor's argument.
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

/// See Material.replace.
PythonMaterial changed_material(PythonMaterial m, const std::optional<Colour>& diffuse,
                                const std::optional<Colour>& specular, std::optional<float> shininess,
                                const std::optional<Colour>& emission,
                                const Typed<"ArrayLike | types.EllipsisType | None">& texture,
                                const std::optional<std::string>& name, std::optional<float> metallic,
                                std::optional<float> roughness, std::optional<float> transmission,
                                std::optional<float> ior, std::optional<float> opacity) {
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

/// Returns the index of a material of the static geometry. Throws InputError if there is no such material.
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
    const auto index = std::get<py::ssize_t>(which);
    if (index >= 0 && static_cast<std::size_t>(index) < names.size()) return static_cast<std::size_t>(index);
    throw InputError("there is no material " + std::to_string(index) + "; the scene has " +
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
                                        R"(Reflection, transmission and emission of a surface. Colours are linear
Rec. 709. Material() creates a Phong material as in Wavefront's MTL files, Material.metallic_roughness one as in
glTF; both describe their properties.)");
    def_hashable_value(material);
    using M = Material;
    constexpr const char* kScalarTexture = "Texture, linear, (H, W, 4), read-only; None: there is none.";
    const std::tuple both{
        Field{"name", &PythonMaterial::name, "Name in Scene.materials; may be empty."},
        Field{"emission", &M::emission, "Emitted radiance in cd/m^2."},
        Field{"transmission", &M::transmission, "Fraction of the surface that is a smooth dielectric interface."},
        Field{"ior", &M::ior, "Index of refraction inside."},
        Field{"absorption", &M::absorption, "Absorption coefficient inside, per metre."},
        Field{"scattering", &M::scattering, "Scattering coefficient inside, per metre."},
        Field{"scattering_anisotropy", &M::scattering_anisotropy, "Mean cosine of the scattering angle inside."},
        Field{"thin", &M::is_thin, "True for a thin film, behind which light continues in its direction."},
        Field{"normal_scale", &M::normal_scale, "Factor on x and y of the normal map."},
        Field{"opacity", &M::opacity, "Opacity, 0 to 1."},
        Field{"opacity_cutoff", &M::opacity_cutoff, "Opacity from which the surface is opaque; 0: partial opacity."},
        Field{"double_sided", &M::emits_on_both_sides, "True if both sides emit light."},
        Field{"texture", &M::diffuse_texture,
              R"(Texture of the diffuse or base colour, (H, W, 4), read-only: uint8 sRGB codes, or float32 of linear
light; None: there is none.)"},
        Field{"specular_texture", &M::specular_texture,
              "Texture of specular, in the format of texture; None: there is none."},
        Field{"emission_texture", &M::emission_texture,
              "Texture of emission, in the format of texture; None: there is none."},
        Field{"transmission_texture", &M::transmission_texture, kScalarTexture},
        Field{"opacity_texture", &M::opacity_texture, kScalarTexture},
        Field{"normal_map", &M::normal_texture, "Normal map, linear, (H, W, 4), read-only; None: there is none."}};
    const std::tuple phong{
        Field{"diffuse", &M::diffuse, "Diffuse reflectance; base colour of a metallic_roughness material."},
        Field{"specular", &M::specular,
              "Reflectance of the Phong lobe; specular_color of a metallic_roughness material."},
        Field{"shininess", &M::shininess, "Phong exponent."},
        Field{"mirror", &M::mirror, "Specular reflectance at normal incidence."},
        Field{"fresnel", &M::fresnel, "True if specular reflection depends on the angle of incidence."},
        Field{"filter", &M::filter, "Factor on transmitted light."},
        Field{"shadow_catcher", &M::only_shadows, "True for a surface that is visible only by shadows on it."}};
    const std::tuple metallic_roughness{
        Field{"metallic", &M::metallic, "0 for a dielectric to 1 for a metal."},
        Field{"roughness", &M::roughness, "Roughness, 0 to 1; the GGX parameter alpha is its square."},
        Field{"specular_weight", &M::specular_weight, "Factor on the dielectric's reflection."},
        Field{"clearcoat", &M::clearcoat, "Fraction of the surface with a clear coat."},
        Field{"clearcoat_roughness", &M::clearcoat_roughness, "Roughness of the clear coat, 0 to 1."},
        Field{"clearcoat_normal_scale", &M::clearcoat_normal_scale, "Factor on x and y of clearcoat_normal_map."},
        Field{"metallic_roughness_texture", &M::metallic_roughness_texture,
              R"(Texture of roughness (green) and metallic (blue), linear, (H, W, 4), read-only; shininess_texture of a
Phong material. None: there is none.)"},
        Field{"specular_weight_texture", &M::specular_weight_texture, kScalarTexture},
        Field{"clearcoat_texture", &M::clearcoat_texture, kScalarTexture},
        Field{"clearcoat_roughness_texture", &M::clearcoat_roughness_texture, kScalarTexture},
        Field{"clearcoat_normal_map", &M::clearcoat_normal_texture,
              "Normal map of the clear coat, linear, (H, W, 4), read-only; None: there is none."}};
    // Names that exist only as constructor arguments.
    const std::tuple phong_arguments{Field{"shininess_texture", &M::metallic_roughness_texture}};
    const std::tuple metallic_roughness_arguments{Field{"base_color", &M::diffuse},
                                                  Field{"specular_color", &M::specular}};
    std::apply([&](const auto&... fields) { (def_property(material, fields), ...); },
               std::tuple_cat(both, phong, metallic_roughness));
    PythonMaterial initial;
    std::apply(
        [&](const auto&... fields) {
            material.def(py::init(maker(initial, fields...)), py::kw_only(),
                         (py::arg(fields.name) = value(initial, fields.member))...,
                         R"(Creates a Phong material as in Wavefront's MTL files. Colours are linear (r, g, b).
diffuse, specular: reflectance of the Lambert lobe and of the Phong lobe. shininess: Phong exponent.
mirror: specular reflectance at normal incidence.
fresnel: True: mirror increases towards grazing incidence (Schlick), and a dielectric interface reflects by its index.
transmission: fraction of the surface, 0 to 1, that is a smooth dielectric interface to a medium inside of index ior.
  filter: factor on the light that passes the interface. absorption, scattering: coefficients of the interior, per
  metre, which must be closed by the surface. scattering_anisotropy: mean cosine of the scattering angle there, -0.99 to
  0.99 (Henyey and Greenstein 1941). thin: True for a thin film without interior, behind which light continues in its
  direction.
emission: radiance in cd/m^2, on the side from which a triangle's vertices appear counterclockwise. double_sided: True:
  on both sides.
texture, specular_texture, emission_texture: factors on diffuse, specular and emission, as arrays (H, W) grey,
  (H, W, 3) or (H, W, 4), row 0 at v = 1, in sRGB: integers 0 to 255, or floats 0 to 1, which are stored as floats. The
  fourth channel (alpha) does not change the colours.
normal_map: normals in tangent space, linear, in the same formats. normal_scale: factor on their x and y.
shininess_texture (green channel), transmission_texture (red channel): factors on shininess and transmission, linear.
opacity: fraction of light that the surface intercepts, 0 to 1; the rest, also of shadow rays, passes straight on.
  opacity_texture: factor on it, linear: the fourth channel, or the mean of fewer channels. opacity_cutoff: above 0, the
  surface is opaque where that product reaches the cutoff, and absent elsewhere.
shadow_catcher: True: the surface is invisible, but darkens what is behind it by the fraction of the lights that is
  occluded there (MTL's illumination model 10). Light passes it; it counts as a bounce.
name: name in Scene.materials. Raises InputError.)");
        },
        std::tuple_cat(phong, phong_arguments, both));
    initial.values.model = MaterialModel::metallic_roughness;
    initial.values.diffuse = initial.values.specular = {1, 1, 1};
    std::apply(
        [&](const auto&... fields) {
            material.def_static(
                "metallic_roughness", maker(initial, fields...), py::kw_only(),
                (py::arg(fields.name) = value(initial, fields.member))...,
                R"(Creates a metallic-roughness material as in glTF: GGX microfacets with alpha = roughness^2.
metallic: 0 for a dielectric on a diffuse base, to 1 for a metal. roughness: 0 to 1. metallic_roughness_texture: factors
  on them, linear: roughness in the green channel, metallic in the blue one.
base_color, times texture: reflectance of the metal or of the diffuse base, or tint of the transmitted light.
transmission: fraction of the dielectric, 0 to 1, that transmits light instead of having a diffuse base.
ior: index of refraction of the dielectric. specular_color, times specular_texture, and specular_weight, times
  specular_weight_texture (fourth channel, or mean of fewer channels): factors on its reflection.
clearcoat: fraction of the surface, 0 to 1, with a colourless coat of index 1.5 on top, which has the mesh's normals or
  those of clearcoat_normal_map; clearcoat_normal_scale: factor on x and y of that map. clearcoat_texture (red channel)
  and clearcoat_roughness_texture (green channel): factors on clearcoat and clearcoat_roughness.
specular_weight_texture, clearcoat_texture, clearcoat_roughness_texture and transmission_texture (red channel) are
linear. Formats of textures, and absorption, scattering, thin, emission, opacity and the other arguments: see
Material(). Raises InputError.)");
        },
        std::tuple_cat(metallic_roughness_arguments, metallic_roughness, both));
    material
        .def("replace", &changed_material, py::kw_only(), "diffuse"_a = py::none(), "specular"_a = py::none(),
             "shininess"_a = py::none(), "emission"_a = py::none(), "texture"_a = py::ellipsis(), "name"_a = py::none(),
             "metallic"_a = py::none(), "roughness"_a = py::none(), "transmission"_a = py::none(), "ior"_a = py::none(),
             "opacity"_a = py::none(),
             R"(Returns the material with some properties changed; those that are omitted stay. texture=None removes the
texture. diffuse is the base colour of a metallic_roughness material, specular its specular_color. Raises InputError.)")
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
            R"(Dict of the materials of the static geometry by name, in their order. Names are those of the file; a
material without a name is "material 3", the second "wood" is "wood.2".)")
        .def("with_material", &with_material, "which"_a, "material"_a,
             R"(Returns the scene with a material replaced, including its textures. which: its name in materials, or its
index from 0. The new material takes over the name. Raises InputError.)")
        .def("with_texture", &with_texture, "material"_a, "pixels"_a,
             R"(Returns the scene with another texture on a material. material: its name in materials, or its index from
0.
pixels: as for Material(texture=...). Raises InputError, also if the vertices have no texture coordinates.)");
}

}  // namespace realcam::bindings
