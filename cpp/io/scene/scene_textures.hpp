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

/// Reads the textures of a scene file; each picture is decoded once per use.
class SceneTextures {
public:
    /// `scene` receives textures and warnings. All arguments must outlive the object.
    SceneTextures(Scene& scene, const FileScene& file, const ImageReader& read_image, Checkpoint& checkpoint);

    /// Texture for a material.
    struct Found {
        TextureReference reference;
        bool is_stand_in;  ///< the picture cannot be read, and the texture is a checker pattern
    };
    /// Returns a picture of the file as a texture in scene.textures, added on first use. A picture that cannot be read
    /// becomes a checker in magenta and black, with a warning. Throws SceneFileError if all textures together need more
    /// memory than is free.
    Found find(const FileTexture& texture, TextureUse use);

    // These functions return textures that made_textures.hpp computes from pictures, added on first use; std::nullopt,
    // with a warning, if a picture cannot be read.

    /// Normal map of a height map; `scale`: factor of its heights.
    std::optional<TextureReference> find_heights(const FileTexture& texture, float scale);
    /// Common texture of two maps; one of them may be absent. It has the transform of the first one that exists.
    std::optional<TextureReference> find_roughness_and_metallic(const FileTexture& roughness,
                                                                const FileTexture& metallic);
    /// Roughness map of a glossiness map; `factor`: factor of the glossiness.
    std::optional<TextureReference> find_glossiness(const FileTexture& texture, float factor);

private:
    /// Kind of a computed texture.
    enum class Made { normals, roughness_and_metallic, roughness };
    /// Key of a computed texture: kind, two pictures (-1 if absent), factor, and whether they repeat.
    using MadeKey = std::tuple<Made, std::int32_t, std::int32_t, float, bool>;
    /// Returns the index of a computed texture. On first use it is made by `make(const DecodedImage*, const
    /// DecodedImage*)` of the two pictures, null if absent.
    template <class Make>
    std::optional<std::int32_t> find_made(const MadeKey& key, Make&& make);
    /// Name of a picture, for the texture.
    std::string name_of(std::int32_t picture) const;

    /// Decodes a picture; std::nullopt, with a warning, if it cannot be read.
    std::optional<DecodedImage> decode(std::int32_t picture);
    struct Added {
        std::int32_t texture;  ///< index in scene_.textures
        bool is_stand_in;  ///< see Found
    };
    /// Returns the texture of a picture, which is decoded on first use.
    Added add(std::int32_t picture, TextureUse use);
    /// Appends a texture to the scene and returns its index.
    std::int32_t append(Texture texture);
    /// Throws SceneFileError if the textures, including a new one of `added` bytes, need too much memory.
    void check_memory(std::size_t added);

    Scene& scene_;
    const FileScene& file_;
    const ImageReader& read_image_;
    Checkpoint& checkpoint_;
    std::map<std::pair<std::int32_t, TextureUse>, Added> added_;
    std::map<MadeKey, std::optional<std::int32_t>> made_;
    std::size_t bytes_ = 0, checked_bytes_ = 0;  ///< size of scene_.textures, now and at the last check
};

/// Converts the materials of the file to scene.materials, with the same indices, with the textures that they need;
/// warns of unsupported properties. Materials without triangles keep default values. `scale`: metres per unit of the
/// file.
void make_materials(Scene& scene, const FileScene& file, double scale, SceneTextures& textures);

}  // namespace realcam::io
