#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <variant>

#include "../scene/scene_checks.hpp"
#include "material.hpp"
#include "short_text.hpp"
#include "triples.hpp"
#include "value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Which = std::variant<py::ssize_t, py::str>;

auto color_property(Color Material::* member) {
    return [member](const PythonMaterial& m) {
        const Color c = m.values.*member;
        return py::make_tuple(c.r, c.g, c.b);
    };
}
auto number_property(float Material::* member) {
    return [member](const PythonMaterial& m) { return m.values.*member; };
}

std::size_t place_of(TextureReference Material::* wanted) {
    std::size_t i = 0;
    while (kMaterialTextures[i] != wanted) ++i;
    return i;
}

/// None: no texture.
void set_texture(PythonMaterial& m, TextureReference Material::* member, const py::object& pixels) {
    m.textures[place_of(member)] = pixels.is_none() ? nullptr : texture_from(pixels, io::use_of(member));
    m.values.*member = {};
}

/// Without a copy, and not to be written to.
auto texture_property(TextureReference Material::* member) {
    return [member](const PythonMaterial& material) -> py::object {
        const std::shared_ptr<const Texture>& texture = material.textures[place_of(member)];
        if (!texture) return py::none();
        using Owner = std::shared_ptr<const Texture>;
        const py::capsule owner(new Owner(texture), [](void* p) { delete static_cast<Owner*>(p); });
        const std::vector<py::ssize_t> shape = {texture->height, texture->width, 4};
        py::array array = texture->rgba.empty()
                              ? py::array(py::array_t<float>(shape, texture->linear_rgba.data(), owner))
                              : py::array(py::array_t<std::uint8_t>(shape, texture->rgba.data(), owner));
        array.attr("flags").attr("writeable") = false;
        return array;
    };
}

/// What both models have.
struct Common {
    Colour emission;
    py::object normal_map, emission_texture;
    float normal_scale, ior, transmission;
    Colour absorption;
    bool thin;
    float opacity, opacity_cutoff;
    py::object opacity_texture;
    bool double_sided;
    py::object transmission_texture, specular_texture;
};

PythonMaterial common(const std::string& name, const Common& from) {
    PythonMaterial m;
    m.name = name;
    m.values.emission = rgb(from.emission);
    set_texture(m, &Material::normal_texture, from.normal_map);
    set_texture(m, &Material::emission_texture, from.emission_texture);
    m.values.normal_scale = from.normal_scale;
    m.values.ior = from.ior;
    m.values.transmission = from.transmission;
    m.values.absorption = rgb(from.absorption);
    m.values.is_thin = from.thin;
    m.values.opacity = from.opacity;
    m.values.opacity_cutoff = from.opacity_cutoff;
    set_texture(m, &Material::opacity_texture, from.opacity_texture);
    m.values.emits_on_both_sides = from.double_sided;
    set_texture(m, &Material::transmission_texture, from.transmission_texture);
    set_texture(m, &Material::specular_texture, from.specular_texture);
    return m;
}

PythonMaterial make_material(const Colour& diffuse, const Colour& specular, float shininess, const Colour& emission,
                             const py::object& texture, const std::string& name, const Colour& mirror, bool fresnel,
                             float transmission, float ior, const Colour& filter, const Colour& absorption, bool thin,
                             const py::object& specular_texture, const py::object& emission_texture,
                             const py::object& normal_map, float normal_scale, float opacity, float opacity_cutoff,
                             const py::object& opacity_texture, bool double_sided, bool shadow_catcher,
                             const py::object& shininess_texture, const py::object& transmission_texture) {
    PythonMaterial m =
        common(name, {emission, normal_map, emission_texture, normal_scale, ior, transmission, absorption, thin,
                      opacity, opacity_cutoff, opacity_texture, double_sided, transmission_texture, specular_texture});
    m.values.only_shadows = shadow_catcher;
    m.values.diffuse = rgb(diffuse);
    m.values.specular = rgb(specular);
    m.values.shininess = shininess;
    m.values.mirror = rgb(mirror);
    m.values.fresnel = fresnel ? FresnelTerm::physical : FresnelTerm::none;
    m.values.filter = rgb(filter);
    set_texture(m, &Material::diffuse_texture, texture);
    set_texture(m, &Material::metallic_roughness_texture, shininess_texture);
    return m;
}

PythonMaterial make_metallic_roughness(const Colour& base_color, float metallic, float roughness,
                                       const py::object& texture, const py::object& metallic_roughness_texture,
                                       float ior, const Colour& specular_color, float specular_weight,
                                       float transmission, const Colour& absorption, bool thin, float clearcoat,
                                       float clearcoat_roughness, const Colour& emission,
                                       const py::object& emission_texture, const py::object& normal_map,
                                       float normal_scale, const std::string& name, float opacity, float opacity_cutoff,
                                       const py::object& opacity_texture, bool double_sided,
                                       const py::object& specular_texture, const py::object& specular_weight_texture,
                                       const py::object& transmission_texture, const py::object& clearcoat_texture,
                                       const py::object& clearcoat_roughness_texture,
                                       const py::object& clearcoat_normal_map, float clearcoat_normal_scale) {
    PythonMaterial m =
        common(name, {emission, normal_map, emission_texture, normal_scale, ior, transmission, absorption, thin,
                      opacity, opacity_cutoff, opacity_texture, double_sided, transmission_texture, specular_texture});
    m.values.model = MaterialModel::metallic_roughness;
    m.values.diffuse = rgb(base_color);
    m.values.metallic = metallic;
    m.values.roughness = roughness;
    m.values.specular = rgb(specular_color);
    m.values.specular_weight = specular_weight;
    m.values.clearcoat = clearcoat;
    m.values.clearcoat_roughness = clearcoat_roughness;
    set_texture(m, &Material::diffuse_texture, texture);
    set_texture(m, &Material::metallic_roughness_texture, metallic_roughness_texture);
    set_texture(m, &Material::specular_weight_texture, specular_weight_texture);
    set_texture(m, &Material::clearcoat_texture, clearcoat_texture);
    set_texture(m, &Material::clearcoat_roughness_texture, clearcoat_roughness_texture);
    set_texture(m, &Material::clearcoat_normal_texture, clearcoat_normal_map);
    m.values.clearcoat_normal_scale = clearcoat_normal_scale;
    return m;
}

PythonMaterial with_numbers(PythonMaterial m, const std::optional<Colour>& diffuse,
                            const std::optional<Colour>& specular, std::optional<float> shininess,
                            const std::optional<Colour>& emission, const py::object& texture,
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
    if (!texture.is(py::ellipsis())) set_texture(m, &Material::diffuse_texture, texture);
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
    material.textures[0] = texture_from(pixels, io::TextureUse::colour);
    material.values.diffuse_texture = {};
    return with_material(scene, which, material);
}

}  // namespace

void bind_material(py::module_& m) {
    py::class_<PythonMaterial> material(m, "Material",
                                        "How a surface reflects and emits light. Colours are linear Rec. 709.");
    def_hashable_value(material);
    const Colour black{0, 0, 0}, white{1, 1, 1};
    material
        .def(py::init(&make_material), py::kw_only(), "diffuse"_a = Colour{0.5f, 0.5f, 0.5f}, "specular"_a = black,
             "shininess"_a = 0.0f, "emission"_a = black, "texture"_a = py::none(), "name"_a = "", "mirror"_a = black,
             "fresnel"_a = true, "transmission"_a = 0.0f, "ior"_a = 1.5f, "filter"_a = white, "absorption"_a = black,
             "thin"_a = false, "specular_texture"_a = py::none(), "emission_texture"_a = py::none(),
             "normal_map"_a = py::none(), "normal_scale"_a = 1.0f, "opacity"_a = 1.0f, "opacity_cutoff"_a = 0.0f,
             "opacity_texture"_a = py::none(), "double_sided"_a = false, "shadow_catcher"_a = false,
             "shininess_texture"_a = py::none(), "transmission_texture"_a = py::none(),
             "Wavefront's material (MTL). diffuse, specular: reflectance of Lambert's and of Phong's lobe; shininess:\n"
             "Phong exponent; emission: radiance in cd/m^2, on the side from which the corners run counter-clockwise;\n"
             "mirror: reflectance as a mirror, at normal incidence; fresnel: whether it grows towards grazing\n"
             "incidence (Schlick), and a smooth border reflects as its index says; transmission: share of the surface\n"
             "that is a smooth border between outside and a medium of index ior, which multiplies what passes by "
             "filter\n"
             "and absorbs on the way, per metre; thin: a film, behind which light goes on as it came.\n"
             "texture, specular_texture, emission_texture: what diffuse, specular and emission are multiplied by,\n"
             "(H, W) grey, (H, W, 3) or (H, W, 4), sRGB codes, row 0 at v = 1: whole numbers from 0 to 255, or "
             "fractions\n"
             "from 0 to 1, which are kept as floats. Colours are taken as they are, whatever the fourth channel\n"
             "(alpha) says. normal_map: directions in tangent space, in the same way but linear; normal_scale: of\n"
             "their x and y. shininess_texture (its green channel) and transmission_texture (red): what those are\n"
             "multiplied by, linear. name: to find it by in Scene.materials.\n"
             "opacity, times opacity_texture (its fourth channel, or the mean of fewer, linear): share of the surface\n"
             "that is there; through the rest light goes as if there were nothing, shadows included. With an\n"
             "opacity_cutoff above 0 there is all of it where that product reaches the cutoff, and nothing elsewhere.\n"
             "double_sided: emission leaves on both sides. shadow_catcher: invisible, but what is seen through it is "
             "as\n"
             "much darker as the lights are hidden from it (MTL's illumination model 10); light and shadows go "
             "through;\n"
             "it counts as a bounce. Raises InputError.")
        .def_static(
            "metallic_roughness", &make_metallic_roughness, py::kw_only(), "base_color"_a = white, "metallic"_a = 0.0f,
            "roughness"_a = 1.0f, "texture"_a = py::none(), "metallic_roughness_texture"_a = py::none(), "ior"_a = 1.5f,
            "specular_color"_a = white, "specular_weight"_a = 1.0f, "transmission"_a = 0.0f, "absorption"_a = black,
            "thin"_a = false, "clearcoat"_a = 0.0f, "clearcoat_roughness"_a = 0.0f, "emission"_a = black,
            "emission_texture"_a = py::none(), "normal_map"_a = py::none(), "normal_scale"_a = 1.0f, "name"_a = "",
            "opacity"_a = 1.0f, "opacity_cutoff"_a = 0.0f, "opacity_texture"_a = py::none(), "double_sided"_a = false,
            "specular_texture"_a = py::none(), "specular_weight_texture"_a = py::none(),
            "transmission_texture"_a = py::none(), "clearcoat_texture"_a = py::none(),
            "clearcoat_roughness_texture"_a = py::none(), "clearcoat_normal_map"_a = py::none(),
            "clearcoat_normal_scale"_a = 1.0f,
            "glTF's material: GGX microfacets of alpha = roughness^2 on a metal, on a dielectric over a diffuse base,\n"
            "or, for the share transmission of it, on a border that lets light through; all between 0 and 1.\n"
            "base_color, times texture: the metal's reflectance, the diffuse one, or the tint of what passes. ior: of\n"
            "the dielectric; specular_color, specular_weight: what its reflection is multiplied by.\n"
            "metallic_roughness_texture: roughness in green and metallic in blue, linear, times the numbers.\n"
            "clearcoat: share of a second, colourless layer of index 1.5 above all, which has the mesh's normals, or\n"
            "those of clearcoat_normal_map. specular_texture: colours that specular_color is multiplied by; linear,\n"
            "and of one channel: specular_weight_texture (the fourth, or the mean of fewer), clearcoat_texture and\n"
            "transmission_texture (red), clearcoat_roughness_texture (green). absorption, thin, emission, opacity and\n"
            "the other textures as in Material(). Raises InputError.")
        .def("replace", &with_numbers, py::kw_only(), "diffuse"_a = py::none(), "specular"_a = py::none(),
             "shininess"_a = py::none(), "emission"_a = py::none(), "texture"_a = py::ellipsis(), "name"_a = py::none(),
             "metallic"_a = py::none(), "roughness"_a = py::none(), "transmission"_a = py::none(), "ior"_a = py::none(),
             "opacity"_a = py::none(),
             "The material with some numbers changed. What is not given stays; texture=None takes the texture away;\n"
             "diffuse is the base colour of a metallic_roughness material, specular its specular_color.")
        .def_property_readonly(
            "model",
            [](const PythonMaterial& p) {
                return p.values.model == MaterialModel::phong ? "phong" : "metallic_roughness";
            },
            "\"phong\" or \"metallic_roughness\".")
        .def_property_readonly("diffuse", color_property(&Material::diffuse),
                               "Reflectance; of metallic_roughness the base colour.")
        .def_property_readonly("specular", color_property(&Material::specular),
                               "Reflectance of Phong's lobe; of metallic_roughness the specular_color.")
        .def_property_readonly("shininess", number_property(&Material::shininess))
        .def_property_readonly("emission", color_property(&Material::emission))
        .def_property_readonly("mirror", color_property(&Material::mirror))
        .def_property_readonly("transmission", number_property(&Material::transmission))
        .def_property_readonly("filter", color_property(&Material::filter))
        .def_property_readonly("absorption", color_property(&Material::absorption), "Per metre.")
        .def_property_readonly("ior", number_property(&Material::ior))
        .def_property_readonly("thin", [](const PythonMaterial& p) { return p.values.is_thin != 0; })
        .def_property_readonly("fresnel", [](const PythonMaterial& p) { return p.values.fresnel != FresnelTerm::none; })
        .def_property_readonly("metallic", number_property(&Material::metallic))
        .def_property_readonly("roughness", number_property(&Material::roughness))
        .def_property_readonly("specular_weight", number_property(&Material::specular_weight))
        .def_property_readonly("clearcoat", number_property(&Material::clearcoat))
        .def_property_readonly("clearcoat_roughness", number_property(&Material::clearcoat_roughness))
        .def_property_readonly("normal_scale", number_property(&Material::normal_scale))
        .def_property_readonly("clearcoat_normal_scale", number_property(&Material::clearcoat_normal_scale))
        .def_property_readonly("opacity", number_property(&Material::opacity))
        .def_property_readonly("opacity_cutoff", number_property(&Material::opacity_cutoff))
        .def_property_readonly("shadow_catcher", [](const PythonMaterial& p) { return p.values.only_shadows != 0; })
        .def_property_readonly("double_sided",
                               [](const PythonMaterial& p) { return p.values.emits_on_both_sides != 0; })
        .def_property_readonly("texture", texture_property(&Material::diffuse_texture),
                               "(H, W, 4), read-only: uint8 codes, or float32 of linear light; None: none.")
        .def_property_readonly("specular_texture", texture_property(&Material::specular_texture))
        .def_property_readonly("emission_texture", texture_property(&Material::emission_texture))
        .def_property_readonly("metallic_roughness_texture", texture_property(&Material::metallic_roughness_texture),
                               "Of Wavefront's material: the shininess_texture.")
        .def_property_readonly("transmission_texture", texture_property(&Material::transmission_texture))
        .def_property_readonly("specular_weight_texture", texture_property(&Material::specular_weight_texture))
        .def_property_readonly("clearcoat_texture", texture_property(&Material::clearcoat_texture))
        .def_property_readonly("clearcoat_roughness_texture", texture_property(&Material::clearcoat_roughness_texture))
        .def_property_readonly("clearcoat_normal_map", texture_property(&Material::clearcoat_normal_texture))
        .def_property_readonly("opacity_texture", texture_property(&Material::opacity_texture))
        .def_property_readonly("normal_map", texture_property(&Material::normal_texture))
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
