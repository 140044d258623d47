#include "shot_scene.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "../error.hpp"
#include "../io/text/help_page.hpp"
#include "../io/text/printable.hpp"
#include "../scene/assembly.hpp"

namespace realcam::shot {
namespace {

using SharedScene = std::shared_ptr<const Scene>;

/// Adds the contents of a SceneRequest to a scene. Each file and texture is read once.
class SceneBuilder {
public:
    SceneBuilder(Assembly scene, const SceneRequest& request, const PictureReaders& readers,
                 const KeepGoing& keep_going)
        : scene_(std::move(scene)), request_(request), readers_(readers), keep_going_(keep_going) {}

    Assembly build() {
        add_objects();
        replace_materials();
        if (!request_.points.empty() || !request_.suns.empty())
            scene_ = with_static_geometry(std::move(scene_), [&](Scene& changed) {
                changed.points.insert(changed.points.end(), request_.points.begin(), request_.points.end());
                changed.suns.insert(changed.suns.end(), request_.suns.begin(), request_.suns.end());
            });
        return std::move(scene_);
    }

private:
    void add_objects() {
        DistinctNames names(scene_);
        std::map<std::pair<std::string, double>, Assembly> files;  // each file is read once
        for (const ObjectRequest& object_request : request_.objects) {
            const auto [file, is_new] = files.try_emplace({object_request.file, object_request.scale});
            if (is_new)
                file->second =
                    io::read_scene(object_request.file, {object_request.scale, {}, keep_going_}, readers_.texture);
            Assembly object = file->second;
            if (!object_request.material.empty()) {
                const MaterialRequest& material = find(object_request);
                used_.insert(&material);
                replace_parts(object, [&](const Scene& part) {
                    return std::make_shared<const Scene>(with_one_material(part, material));
                });
            }
            add(scene_, object, object_request.placement, object_request.name, names);
        }
    }

    /// Returns the table of the material that an object names. Throws InputError if there is none.
    const MaterialRequest& find(const ObjectRequest& object) const {
        std::vector<std::string> names;
        for (const MaterialRequest& material : request_.materials) {
            if (material.name == object.material) return material;
            names.push_back(material.name);
        }
        throw InputError(object.location + ": there is no table [material." + object.material + "]" +
                         io::did_you_mean(object.material, names));
    }

    /// Replaces the scene's materials by those of the same name in the request. Throws InputError if the scene has
    /// none.
    void replace_materials() {
        for (const MaterialRequest& material : request_.materials) {
            bool found = false;
            std::set<std::string> names;
            replace_parts(scene_, [&](const Scene& part) -> SharedScene {
                names.insert(part.material_names.begin(), part.material_names.end());
                if (std::find(part.material_names.begin(), part.material_names.end(), material.name) ==
                    part.material_names.end())
                    return nullptr;
                found = true;
                Scene changed = part;
                for (std::size_t i = 0; i < part.materials.size(); ++i)
                    if (part.material_names[i] == material.name) replace_material(changed, i, material);
                return std::make_shared<const Scene>(std::move(changed));
            });
            if (!found && !used_.contains(&material))
                throw InputError(material.location + ": the scene has no material " + io::in_quotes(material.name) +
                                 io::did_you_mean(material.name, {names.begin(), names.end()}));
        }
    }

    /// Replaces static geometry and objects by f(part), or leaves them unchanged if f returns null. A part that several
    /// instances share is replaced once.
    template <class F>
    static void replace_parts(Assembly& scene, F&& f) {
        std::map<const Scene*, SharedScene> replacements;
        const auto change = [&](SharedScene& part) {
            const auto [known, is_new] = replacements.try_emplace(part.get());
            if (is_new) known->second = f(*part);
            if (known->second) part = known->second;
        };
        change(scene.static_geometry);
        for (Instance& instance : scene.instances) change(instance.object);
    }

    /// Returns a copy of a part whose triangles all have the given material.
    Scene with_one_material(const Scene& part, const MaterialRequest& material) {
        Scene changed = part;
        changed.materials.resize(1);
        changed.material_names = {material.name};
        changed.textures.clear();
        for (Triangle& triangle : changed.triangles) triangle.material = 0;
        replace_material(changed, 0, material);
        return changed;
    }

    /// Sets a material of a scene, and adds its textures.
    void replace_material(Scene& scene, std::size_t index, const MaterialRequest& replacement) {
        Material material = replacement.values;
        for (std::size_t i = 0; i < kMaterialTextures.size(); ++i) {
            if (replacement.textures[i].empty()) continue;
            if (scene.uvs.empty())
                throw InputError(replacement.location +
                                 ": the material's object has no texture coordinates, which a texture needs");
            (material.*kMaterialTextures[i]).texture = static_cast<std::int32_t>(scene.textures.size());
            scene.textures.push_back(texture(replacement.textures[i], io::use_of(kMaterialTextures[i])));
        }
        scene.materials[index] = material;
    }

    /// Returns a texture, which is read at the first call.
    const Texture& texture(const std::string& path, io::TextureUse use) {
        const auto [known, is_new] = textures_.try_emplace({path, use});
        if (is_new) known->second = read_texture(path, use, readers_);
        return known->second;
    }

    Assembly scene_;
    const SceneRequest& request_;
    const PictureReaders& readers_;
    const KeepGoing& keep_going_;
    std::set<const MaterialRequest*> used_;  // those that objects of the request name
    std::map<std::pair<std::string, io::TextureUse>, Texture> textures_;
};

}  // namespace

Texture read_texture(const std::string& path, io::TextureUse use, const PictureReaders& readers) {
    std::string reason;
    try {
        if (auto image = readers.texture(path, {})) return io::texture_of(std::move(*image), use, path);
    } catch (const Cancelled&) {
        throw;
    } catch (const InputError&) {
        throw;
    } catch (const Error& error) {
        reason = std::string(": ") + error.what();
    }
    throw InputError(path + ": cannot be read as a texture" + reason);
}

Assembly with_additions(Assembly scene, const SceneRequest& request, const PictureReaders& readers,
                        const KeepGoing& keep_going) {
    return SceneBuilder(std::move(scene), request, readers, keep_going).build();
}

}  // namespace realcam::shot
