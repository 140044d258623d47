#include "read_scene_request.hpp"

#include <algorithm>
#include <cmath>

#include "../math/affine.hpp"
#include "../scene/assembly.hpp"
#include "../scene/scene_checks.hpp"

namespace realcam::shot {
namespace {

namespace fs = std::filesystem;

Color color_of(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Checks a material, or lights, in a minimal scene by the checks of scenes, so that the caller can report errors at
/// their lines. Throws InputError.
void check(const Scene& part) {
    const std::string kWhere = "scene: material 0: ";
    Scene scene = part;
    scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{{0, 1, 2}, 0}};
    scene.materials.resize(1);
    try {
        validate(scene);
    } catch (const InputError& error) {
        const std::string text = error.what();
        throw InputError(text.starts_with(kWhere) ? text.substr(kWhere.size()) : text);
    }
}

/// Reads a table [material.NAME].
class MaterialReader {
public:
    MaterialReader(const ShotTable& table, const std::string& name) : table_(table) {
        request_.name = name;
        request_.location = table.location();
    }

    MaterialRequest read() {
        const auto model = table_.named(
            "model",
            [](const std::string& text) -> std::optional<MaterialModel> {
                if (text == "phong") return MaterialModel::phong;
                if (text == "metallic_roughness") return MaterialModel::metallic_roughness;
                return std::nullopt;
            },
            "phong or metallic_roughness");
        m_.model = model.value_or(MaterialModel::phong);
        if (m_.model == MaterialModel::phong)
            read_phong();
        else
            read_metallic_roughness();
        read_common();
        table_.checked(nullptr, [&] {
            Scene scene;
            scene.materials = {m_};
            check(scene);
        });
        return request_;
    }

private:
    /// Rejects keys other than these and those that both material models have.
    void allow(std::vector<std::string_view> keys) const {
        for (const char* common :
             {"model", "texture", "emission", "emission_texture", "double_sided", "transmission",
              "transmission_texture", "ior", "absorption", "scattering", "scattering_anisotropy", "thin", "opacity",
              "opacity_cutoff", "opacity_texture", "normal_map", "normal_scale"})
            keys.emplace_back(common);
        table_.allow(keys);
    }

    void read_phong() {
        allow({"diffuse", "specular", "specular_texture", "shininess", "shininess_texture", "mirror", "fresnel",
               "filter", "shadow_catcher"});
        color("diffuse", m_.diffuse);
        color("specular", m_.specular);
        number("shininess", m_.shininess);
        color("mirror", m_.mirror);
        if (table_.find("fresnel") && !table_.flag("fresnel")) m_.fresnel = FresnelTerm::none;
        color("filter", m_.filter);
        m_.only_shadows = table_.flag("shadow_catcher");
        texture("shininess_texture", &Material::metallic_roughness_texture);
    }

    void read_metallic_roughness() {
        allow({"base_color", "metallic", "roughness", "metallic_roughness_texture", "specular_color",
               "specular_texture", "specular_weight", "specular_weight_texture", "clearcoat", "clearcoat_texture",
               "clearcoat_roughness", "clearcoat_roughness_texture", "clearcoat_normal_map", "clearcoat_normal_scale"});
        m_.diffuse = m_.specular = {1, 1, 1};
        color("base_color", m_.diffuse);
        number("metallic", m_.metallic);
        number("roughness", m_.roughness);
        color("specular_color", m_.specular);
        number("specular_weight", m_.specular_weight);
        number("clearcoat", m_.clearcoat);
        number("clearcoat_roughness", m_.clearcoat_roughness);
        texture("metallic_roughness_texture", &Material::metallic_roughness_texture);
        texture("specular_weight_texture", &Material::specular_weight_texture);
        texture("clearcoat_texture", &Material::clearcoat_texture);
        texture("clearcoat_roughness_texture", &Material::clearcoat_roughness_texture);
        texture("clearcoat_normal_map", &Material::clearcoat_normal_texture);
        number("clearcoat_normal_scale", m_.clearcoat_normal_scale);
    }

    void read_common() {
        texture("texture", &Material::diffuse_texture);
        color("emission", m_.emission);
        texture("emission_texture", &Material::emission_texture);
        m_.emits_on_both_sides = table_.flag("double_sided");
        number("transmission", m_.transmission);
        texture("transmission_texture", &Material::transmission_texture);
        texture("specular_texture", &Material::specular_texture);
        number("ior", m_.ior);
        color("absorption", m_.absorption);
        color("scattering", m_.scattering);
        number("scattering_anisotropy", m_.scattering_anisotropy);
        m_.is_thin = table_.flag("thin");
        number("opacity", m_.opacity);
        number("opacity_cutoff", m_.opacity_cutoff);
        texture("opacity_texture", &Material::opacity_texture);
        texture("normal_map", &Material::normal_texture);
        number("normal_scale", m_.normal_scale);
    }

    // Set a value if the table has the key.
    void color(const char* key, Color& value) const {
        if (const auto v = table_.number_or_three(key)) value = color_of(*v);
    }
    void number(const char* key, float& value) const {
        if (const auto v = table_.number(key)) value = static_cast<float>(*v);
    }
    void texture(const char* key, TextureReference Material::* member) {
        const auto texture = std::find(kMaterialTextures.begin(), kMaterialTextures.end(), member);
        request_.textures[static_cast<std::size_t>(texture - kMaterialTextures.begin())] = table_.path(key);
    }

    ShotTable table_;
    MaterialRequest request_;
    Material& m_ = request_.values;
};

/// Reads a transform to the scene: the first three rows of "matrix" (given by rows), or position, rotation and stretch.
Affine<double> transform_of(const ShotTable& table) {
    const std::vector<double> m = table.numbers("matrix", 16);
    if (!m.empty()) {
        for (const char* other : {"position_m", "rotation_deg", "stretch"})
            if (table.find(other)) table.fail('"' + std::string(other) + "\" and \"matrix\" exclude each other");
        if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
            table.fail("the last row of \"matrix\" must be 0, 0, 0, 1", table.find("matrix"));
        return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
    }
    Affine<double> stretch;
    const Vec3d factors = table.number_or_three("stretch").value_or(Vec3d{1, 1, 1});
    stretch.x.x = factors.x;
    stretch.y.y = factors.y;
    stretch.z.z = factors.z;
    Affine<double> map = euler_rotation(table.point("rotation_deg").value_or(Vec3d{0, 0, 0})) * stretch;
    map.origin = table.point("position_m").value_or(Vec3d{0, 0, 0});
    return map;
}

/// Reads the placement of an object: a transform, or the keyframes [[object.key]].
AnimatedTransform placement_of(const ShotTable& table) {
    Motion motion;
    for (const ShotTable& key : table.tables("key")) {
        key.allow({"time_s", "position_m", "rotation_deg", "stretch", "matrix"});
        motion.times_s.push_back(key.required_number("time_s"));
        motion.transforms.push_back(transform_of(key));
    }
    if (motion.times_s.empty()) {
        const Affine<double> map = transform_of(table);
        if (const std::string why = transform_error(map); !why.empty()) table.fail(why);
        return map;
    }
    for (const char* other : {"position_m", "rotation_deg", "stretch", "matrix"})
        if (const toml::node* node = table.find(other))
            table.fail('"' + std::string(other) + "\" and [[object.key]] exclude each other", node);
    if (const std::string why = motion_error(motion); !why.empty()) table.fail(why);
    return motion;
}

ObjectRequest read_object(const ShotTable& table) {
    table.allow({"file", "name", "scale", "position_m", "rotation_deg", "stretch", "matrix", "material", "key"});
    ObjectRequest object;
    object.location = table.location();
    object.file = table.path("file");
    if (object.file.empty()) table.fail("file is missing: the scene file to insert");
    object.name = table.name("name");
    if (object.name.empty()) object.name = fs::path(object.file).stem().string();
    object.scale = table.number("scale").value_or(1);
    if (!(object.scale > 0)) table.fail("\"scale\" must be a positive number of metres", table.find("scale"));
    object.placement = placement_of(table);
    object.material = table.name("material");
    return object;
}

/// Reads the key "direction", and normalises it.
Vec3d unit_direction(const ShotTable& table) {
    const Vec3d d = table.required_point("direction");
    if (!(length(d) > 0) || !std::isfinite(length(d)))
        table.fail("\"direction\" must be a vector other than zero", table.find("direction"));
    return normalized(d);
}

/// Reads the strength of a light: one number, or red, green and blue.
Color strength(const ShotTable& table, const char* key) {
    const auto v = table.number_or_three(key);
    if (!v) table.fail('"' + std::string(key) + "\" is missing: a number, or three");
    return color_of(*v);
}

/// Reads a table [[light]] and adds the light to the request.
void read_light(const ShotTable& table, SceneRequest& request) {
    Scene light;
    const std::string type = table.text("type");
    if (type == "point") {
        table.allow({"type", "position_m", "intensity_cd"});
        light.points.push_back({table.required_point("position_m"), strength(table, "intensity_cd")});
    } else if (type == "spot") {
        table.allow({"type", "position_m", "direction", "intensity_cd", "inner_cone_deg", "outer_cone_deg"});
        light.points.push_back({table.required_point("position_m"), strength(table, "intensity_cd"),
                                unit_direction(table), kDegree * table.number("inner_cone_deg").value_or(0),
                                kDegree * table.number("outer_cone_deg").value_or(45)});
    } else if (type == "sun") {
        table.allow({"type", "direction", "illuminance_lux"});
        light.suns.push_back({static_cast<Vec3f>(unit_direction(table)), strength(table, "illuminance_lux")});
    } else {
        table.fail("\"type\" must be \"point\", \"spot\" or \"sun\"", table.find("type"));
    }
    table.checked(nullptr, [&] { check(light); });
    request.points.insert(request.points.end(), light.points.begin(), light.points.end());
    request.suns.insert(request.suns.end(), light.suns.begin(), light.suns.end());
}

}  // namespace

SceneRequest read_scene_request(const ShotTable& shot) {
    SceneRequest request;
    for (const auto& [name, table] : shot.named_tables("material"))
        request.materials.push_back(MaterialReader(table, name).read());
    for (const ShotTable& table : shot.tables("object")) request.objects.push_back(read_object(table));
    for (const ShotTable& table : shot.tables("light")) read_light(table, request);
    return request;
}

}  // namespace realcam::shot
