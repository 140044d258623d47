#include "scene_checks.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <sstream>

namespace realcam {

namespace {

// Traversal and planes need its cube, which is still far below the largest float.
constexpr double kMaxCoordinate_m = 1e12;
// Limits of radiance (cd/m^2) and illuminance (lux), and of intensity (cd): beyond all real emitters, the sun as a
// point light included; products with distances or lobes are still finite floats.
constexpr float kMaxRadiance = 1e20f, kMaxIntensity = 1e30f;

bool is_finite(Vec3f v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_reflectance(Color c) {
    return is_finite({c.r, c.g, c.b}) && c.r >= 0 && c.g >= 0 && c.b >= 0;
}

bool is_between_0_and(Color c, float max) {
    return is_reflectance(c) && largest(c) <= max;
}

}  // namespace

bool in_reach(Vec3d p_m) {
    return std::abs(p_m.x) <= kMaxCoordinate_m && std::abs(p_m.y) <= kMaxCoordinate_m &&
           std::abs(p_m.z) <= kMaxCoordinate_m;
}

std::string coordinates_error(Vec3d p) {
    std::ostringstream text;
    text << "coordinates must be finite numbers" << (is_finite(p) ? " of at most 1e12 m" : "") << ", not (" << p.x
         << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

namespace {

/// Returns why a texture is invalid; empty if it is valid. Throws Cancelled if `checkpoint` does.
std::string texture_error(const Texture& t, Checkpoint& checkpoint) {
    const std::size_t texels =
        static_cast<std::size_t>(std::max(t.width, 0)) * static_cast<std::size_t>(std::max(t.height, 0));
    if (texels == 0 || (t.rgba.empty() ? t.linear_rgba.size() : t.rgba.size()) != 4 * texels)
        return "must hold width x height x 4 numbers";
    checkpoint.pass(t.linear_rgba.size());
    for (const float v : t.linear_rgba)
        if (!(v >= 0 && std::isfinite(v))) return "must hold finite numbers, none below 0";
    return "";
}

/// Throws InputError if the pose or the field of a scene's camera is invalid.
void check_camera(const SceneCamera& camera) {
    const auto& [x, y, z, origin] = camera.scene_from_camera;
    const bool is_posed = is_finite(x) && is_finite(y) && is_finite(z) && is_finite(origin) &&
                          (!camera.motion || motion_error(*camera.motion).empty());
    if (!is_posed || !(camera.vertical_field_rad >= 0 && camera.vertical_field_rad < std::numbers::pi))
        throw InputError("a camera of the scene needs a valid pose, and a field of view from 0 to 180 degrees");
}

/// Throws InputError if an instance is a part of one that does not come before it.
void check_parent(const Assembly& scene, std::size_t instance) {
    const std::ptrdiff_t parent = scene.instances[instance].part_of;
    if (parent < Instance::kNoParentInstance || parent >= static_cast<std::ptrdiff_t>(instance))
        throw InputError(label(scene, instance) + " is a part of instance " + std::to_string(parent) +
                         "; expected an instance before it in the list");
}

/// Returns why the air is invalid; empty if it is valid.
std::string air_error(const Air& air) {
    if (!is_between_0_and(air.extinction, 1e6f)) return "the air's extinction must lie between 0 and 1e6 per metre";
    if (!is_between_0_and(air.albedo, 1)) return "the air's albedo must lie between 0 and 1";
    if (!(std::fabs(air.anisotropy) <= kMaxAnisotropy)) return "the air's anisotropy must lie between -0.99 and 0.99";
    if (air.margin_m && !(*air.margin_m >= 0 && *air.margin_m <= 1e12))
        return "the air's margin must lie between 0 and 1e12 m";
    return "";
}

/// Checks one Scene; see validate.
class Checker {
public:
    Checker(const Scene& scene, const std::string& file, Checkpoint& checkpoint)
        : scene_(scene), file_(file), checkpoint_(checkpoint) {}

    void check(bool may_be_empty) const {
        if (scene_.triangles.empty() && !may_be_empty)
            throw SceneFileError((file_.empty() ? "the scene" : file_ + ":") + std::string(" holds no triangles"));
        check_vertices();
        check_triangles();
        if (scene_.deformation)
            if (const std::string why = deformation_error(*scene_.deformation, scene_.positions_m.size()); !why.empty())
                fail("its deformation: " + why);
        check_materials();
        check_textures();
        check_lights();
        check_environment();
        check_air();
    }

private:
    /// Fails if an element, such as the vertex of this index, does not meet a requirement.
    void require(bool is_met, const std::string& element, std::size_t index, const std::string& requirement) const {
        if (!is_met) fail(element + " " + std::to_string(index) + ": " + requirement);
    }
    /// Throws SceneFileError for a file, InputError otherwise.
    [[noreturn]] void fail(const std::string& message) const {
        if (file_.empty()) throw InputError("scene: " + message);
        throw SceneFileError(file_ + ": " + message);
    }

    void check_vertices() const {
        const std::size_t count = scene_.positions_m.size();
        for (std::size_t i = 0; i < count; ++i) {
            checkpoint_.pass();
            if (!in_reach(scene_.positions_m[i])) {
                require(false, "vertex", i, "coordinates must be finite numbers of at most 1e12 m");
            }
        }
        const auto require_none_or_one_each = [&](std::size_t size, const char* attribute) {
            if (size != 0 && size != count) {
                fail(std::to_string(size) + " " + attribute + " for " + std::to_string(count) +
                     " vertices; expected none or one for each");
            }
        };
        require_none_or_one_each(scene_.normals.size(), "normals");
        require_none_or_one_each(scene_.uvs.size(), "texture coordinates");
        require_none_or_one_each(scene_.second_uvs.size(), "texture coordinates of the second set");
        require_none_or_one_each(scene_.colors.size(), "colours of vertices");
        for (std::size_t i = 0; i < scene_.normals.size(); ++i) {
            if (!is_finite(scene_.normals[i])) require(false, "normal", i, "must be finite numbers");
        }
        for (std::size_t i = 0; i < scene_.colors.size(); ++i) {
            const VertexColor& c = scene_.colors[i];
            require(is_reflectance(c.color) && c.alpha >= 0 && c.alpha <= 1, "colour of vertex", i,
                    "must be finite and not negative, and its alpha must lie between 0 and 1");
        }
        for (const std::vector<Vec2f>* uvs : {&scene_.uvs, &scene_.second_uvs})
            for (std::size_t i = 0; i < uvs->size(); ++i) {
                if (!std::isfinite((*uvs)[i].x) || !std::isfinite((*uvs)[i].y))
                    require(false, "texture coordinate", i, "must be finite numbers");
            }
    }

    void check_triangles() const {
        const auto fail_for = [&](std::size_t t, std::uint32_t index, const char* element, std::size_t count) {
            fail("triangle " + std::to_string(t) + ": " + element + " " + std::to_string(index) +
                 " does not exist; there are " + std::to_string(count));
        };
        for (std::size_t t = 0; t < scene_.triangles.size(); ++t) {
            checkpoint_.pass();
            const Triangle& triangle = scene_.triangles[t];
            for (const std::uint32_t v : triangle.vertices) {
                if (v >= scene_.positions_m.size()) fail_for(t, v, "vertex", scene_.positions_m.size());
            }
            if (triangle.material >= scene_.materials.size()) {
                fail_for(t, triangle.material, "material", scene_.materials.size());
            }
        }
    }

    void check_materials() const {
        const auto textures = static_cast<std::int64_t>(scene_.textures.size());
        if (!scene_.material_names.empty() && scene_.material_names.size() != scene_.materials.size())
            fail(std::to_string(scene_.material_names.size()) + " names for " +
                 std::to_string(scene_.materials.size()) + " materials; expected none or one for each");
        for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
            const Material& m = scene_.materials[i];
            require(is_reflectance(m.diffuse), "material", i, "diffuse reflectance must be finite and not negative");
            require(is_reflectance(m.specular), "material", i, "specular reflectance must be finite and not negative");
            require(m.shininess >= 0 && m.shininess <= 1e9f, "material", i,
                    "the Phong exponent must lie between 0 and 1e9");
            require(is_between_0_and(m.emission, kMaxRadiance), "material", i,
                    "emission must lie between 0 and 1e20 cd/m^2");
            require(is_between_0_and(m.filter, 1.0f), "material", i,
                    "the factor of transmitted light must lie between 0 and 1");
            require(is_reflectance(m.mirror), "material", i, "mirror reflectance must be finite and not negative");
            require(is_reflectance(m.absorption) && is_reflectance(m.scattering) &&
                        is_reflectance(m.absorption + m.scattering),
                    "material", i, "absorption, scattering and their sum must be finite and not negative");
            require(std::fabs(m.scattering_anisotropy) <= kMaxAnisotropy, "material", i,
                    "the anisotropy of scattering must lie between -0.99 and 0.99");
            require(m.ior >= 0 && m.ior <= 1000, "material", i, "the refractive index must lie between 0 and 1000");
            for (const float v : {m.transmission, m.metallic, m.roughness, m.specular_weight, m.clearcoat,
                                  m.clearcoat_roughness, m.opacity, m.opacity_cutoff})
                require(v >= 0 && v <= 1, "material", i,
                        "transmission, metallic, roughness, specular weight, clearcoat and its roughness, opacity and "
                        "its cutoff must lie between 0 and 1");
            require(std::isfinite(m.normal_scale) && std::isfinite(m.clearcoat_normal_scale), "material", i,
                    "the normal map's scale must be finite");
            for (const auto member : kMaterialTextures) check_reference(m.*member, i, textures);
        }
    }

    void check_reference(const TextureReference& reference, std::size_t material, std::int64_t textures) const {
        require(
            reference.texture >= -1 && reference.texture < textures, "material", material,
            "texture " + std::to_string(reference.texture) + " does not exist; there are " + std::to_string(textures));
        require(reference.texture < 0 || !scene_.uvs.empty(), "material", material,
                "has a texture, but the vertices have no texture coordinates");
        require(reference.uv_set == 0 || (reference.uv_set == 1 && !scene_.second_uvs.empty()), "material", material,
                "has a texture that uses a second set of texture coordinates, which the vertices do not have");
        require(is_finite(reference.to_u) && is_finite(reference.to_v), "material", material,
                "a texture's transform must consist of finite numbers");
        const TextureSampler& s = reference.sampler;
        const auto is_wrap = [](TextureWrap w) { return w >= TextureWrap::repeat && w <= TextureWrap::mirror; };
        require(is_wrap(s.u) && is_wrap(s.v) && s.filter >= TextureFilter::linear && s.filter <= TextureFilter::nearest,
                "material", material, "a texture's sampler is unknown");
    }

    void check_textures() const {
        for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
            const std::string why = texture_error(scene_.textures[i], checkpoint_);
            require(why.empty(), "texture", i, why);
        }
    }

    void check_lights() const {
        for (std::size_t i = 0; i < scene_.points.size(); ++i) {
            require(in_reach(scene_.points[i].position_m), "point light", i, "its position must be finite");
            require(is_between_0_and(scene_.points[i].intensity, kMaxIntensity), "point light", i,
                    "its intensity must lie between 0 and 1e30 cd");
            const ScenePointLight& p = scene_.points[i];
            const double size = length(p.axis);
            require(size == 0 || std::abs(size - 1) < 1e-3, "point light", i, "a spot's axis must have length 1");
            require(p.inner_cone_rad >= 0 && p.inner_cone_rad <= p.outer_cone_rad && p.outer_cone_rad <= 1.5707964,
                    "point light", i, "a spot's cones must lie between 0 and pi / 2, the inner one in the outer one");
        }
        for (std::size_t i = 0; i < scene_.suns.size(); ++i) {
            const Vec3f d = scene_.suns[i].direction;
            require(is_finite(d) && std::abs(length(d) - 1.0f) < 1e-3f, "sun", i, "its direction must have length 1");
            require(is_between_0_and(scene_.suns[i].illuminance, kMaxRadiance), "sun", i,
                    "its illuminance must lie between 0 and 1e20 lux");
        }
    }

    void check_environment() const {
        const Environment& e = scene_.environment;
        if (!is_between_0_and(e.constant, kMaxRadiance))
            fail("environment: radiance must lie between 0 and 1e20 cd/m^2");
        if (e.pixels.empty()) return;
        if (e.width <= 0 || e.height <= 0 ||
            e.pixels.size() != static_cast<std::size_t>(e.width) * static_cast<std::size_t>(e.height)) {
            fail("environment: expected width x height pixels");
        }
        if (!std::all_of(e.pixels.begin(), e.pixels.end(), [](Color c) { return is_between_0_and(c, kMaxRadiance); })) {
            fail("environment: radiance must lie between 0 and 1e20 cd/m^2 in every pixel");
        }
    }

    void check_air() const {
        if (const std::string why = air_error(scene_.air); !why.empty()) fail(why);
    }

    const Scene& scene_;
    const std::string& file_;
    Checkpoint& checkpoint_;
};

}  // namespace

void validate(const Scene& scene, const std::string& file, bool may_be_empty, Checkpoint& checkpoint) {
    Checker(scene, file, checkpoint).check(may_be_empty);
}

void validate(const Scene& scene, const std::string& file, bool may_be_empty) {
    Checkpoint never_stops;
    validate(scene, file, may_be_empty, never_stops);
}

void validate(const Texture& texture) {
    Checkpoint never_stops;
    if (const std::string why = texture_error(texture, never_stops); !why.empty()) throw InputError("a texture " + why);
}

void validate(const Air& air) {
    if (const std::string why = air_error(air); !why.empty()) throw InputError(why);
}

void SceneChecks::check(const Assembly& scene, const std::string& file, const KeepGoing& keep_going) {
    Checkpoint checkpoint(keep_going);
    try {
        if (!scene.static_geometry) throw InputError("the scene is empty; expected at least one triangle");
        if (!same_parts(last_, scene)) {
            check_parts(scene, file, checkpoint);
            validate(scene);
        } else if (!same_transforms(last_, scene)) {
            validate_transforms(scene);
        } else {
            return;
        }
    } catch (const InputError& error) {
        if (file.empty()) throw;
        throw SceneFileError(file + ": " + error.what());
    }
    last_ = scene;
}

void SceneChecks::check_parts(const Assembly& scene, const std::string& file, Checkpoint& checkpoint) const {
    std::set<const Scene*> checked{last_.static_geometry.get()};
    for (const Instance& instance : last_.instances) checked.insert(instance.object.get());
    // Geometry that was valid as an object may be invalid as a whole scene: it may have no triangles.
    if (scene.static_geometry->deformation) throw InputError("only instanced objects may deform");
    if (checked.insert(scene.static_geometry.get()).second || scene.instances.empty())
        validate(*scene.static_geometry, file, !scene.instances.empty(), checkpoint);
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        checkpoint.pass();
        const Scene* const object = scene.instances[i].object.get();
        if (!object) throw InputError(label(scene, i) + " has no object");
        check_parent(scene, i);
        if (checked.insert(object).second) validate(*object, file, true, checkpoint);
    }
    for (const SceneCamera& camera : scene.cameras) check_camera(camera);
}

bool is_degenerate(const Scene& scene, const Triangle& triangle) {
    const Vec3d a = scene.positions_m[triangle.vertices[0]], b = scene.positions_m[triangle.vertices[1]],
                c = scene.positions_m[triangle.vertices[2]];
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    const double twice_area = length(cross(b - a, c - a));
    // Renderers normalise the cross product in float; its square must not underflow.
    return !(twice_area > 2e-18) || !(twice_area > 1e-12 * longest);
}

}  // namespace realcam
