#pragma once
#include <map>
#include <optional>
#include <utility>

#include "../checkpoint.hpp"
#include "../scene/scene.hpp"
#include "file_scene.hpp"
#include "scene_file.hpp"

namespace realcam::io {

/// The pictures of a scene file, each decoded once.
class SceneTextures {
public:
    /// `scene`: gets textures and warnings. All arguments have to outlive it.
    SceneTextures(Scene& scene, const FileScene& file, const ImageReader& read_image, Checkpoint& checkpoint);

    struct Found {
        TextureReference reference;
        bool is_stand_in;
    };
    /// A picture of the file's as a texture in scene.textures, added if it is new. One that cannot be had becomes a
    /// checker in magenta and black, with a warning. Throws SceneFileError where all together need more memory than is
    /// free.
    Found find(const FileTexture& texture, TextureUse use);

private:
    std::optional<DecodedImage> decode(std::int32_t picture);
    struct Added {
        std::int32_t texture;  // in scene_.textures
        bool is_stand_in;
    };
    Added add(std::int32_t picture, TextureUse use);
    void check_memory(std::size_t added);

    Scene& scene_;
    const FileScene& file_;
    const ImageReader& read_image_;
    Checkpoint& checkpoint_;
    std::map<std::pair<std::int32_t, TextureUse>, Added> added_;
    std::size_t bytes_ = 0, checked_bytes_ = 0;  // of scene_.textures
};

}  // namespace realcam::io
