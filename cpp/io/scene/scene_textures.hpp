#pragma once
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"
#include "decoded_image.hpp"
#include "file_scene.hpp"

namespace realcam::io {

/// Textures of a scene file; each picture is decoded once.
class SceneTextures {
public:
    /// `scene` receives textures and warnings. All arguments have to outlive the object.
    SceneTextures(Scene& scene, const FileScene& file, const ImageReader& read_image, Checkpoint& checkpoint);

    struct Found {
        TextureReference reference;
        bool is_stand_in;
    };
    /// Returns a picture of the file as a texture in scene.textures, added on first use. A picture that cannot be read
    /// becomes a checker in magenta and black, with a warning. Throws SceneFileError if all textures together need more
    /// memory than is free.
    Found find(const FileTexture& texture, TextureUse use);

    /// Return textures that made_textures.hpp computes from pictures. A height map times `scale` becomes a normal map.
    /// Maps of roughness and metallic become one, with the transform of the first that exists. A map of glossiness
    /// times `factor` becomes one of roughness. std::nullopt if a picture cannot be read.
    std::optional<TextureReference> find_heights(const FileTexture& texture, float scale);
    std::optional<TextureReference> find_roughness_and_metallic(const FileTexture& roughness,
                                                                const FileTexture& metallic);
    std::optional<TextureReference> find_glossiness(const FileTexture& texture, float factor);

private:
    /// Kind of a computed texture. Its key: the pictures (-1 if absent), the factor, and whether they repeat.
    enum class Made { normals, roughness_and_metallic, roughness };
    using MadeKey = std::tuple<Made, std::int32_t, std::int32_t, float, bool>;
    template <class Make>
    std::optional<std::int32_t> made(const MadeKey& key, Make&& make);
    std::string name_of(std::int32_t picture) const;

    std::optional<DecodedImage> decode(std::int32_t picture);
    struct Added {
        std::int32_t texture;  // index in scene_.textures
        bool is_stand_in;
    };
    Added add(std::int32_t picture, TextureUse use);
    std::int32_t keep(Texture texture);
    void check_memory(std::size_t added);

    Scene& scene_;
    const FileScene& file_;
    const ImageReader& read_image_;
    Checkpoint& checkpoint_;
    std::map<std::pair<std::int32_t, TextureUse>, Added> added_;
    std::map<MadeKey, std::optional<std::int32_t>> made_;
    std::size_t bytes_ = 0, checked_bytes_ = 0;  // size of scene_.textures
};

/// Makes scene.materials from the materials of the file, with the same indices, and the textures that they need; warns
/// of properties that are not modelled. `scale`: metres per unit of the file.
void make_materials(Scene& scene, const FileScene& file, double scale, SceneTextures& textures);

}  // namespace realcam::io
