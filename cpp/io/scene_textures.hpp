#pragma once
#include <assimp/scene.h>

#include <map>
#include <optional>
#include <string>

#include "../scene/scene.hpp"
#include "scene_file.hpp"

namespace realcam::io {

/// The pictures of a scene file, each decoded once.
class SceneTextures {
public:
    /// All arguments have to outlive it. `content`: where pictures may be inside, or null. `path`: of the scene file.
    SceneTextures(Scene& scene, const aiScene* content, const std::string& path, const ImageReader& read_image);

    struct Found {
        std::int32_t index;
        bool stand_in;
    };
    /// Number in scene.textures of the picture with this name in the file, added if it is new. A picture that cannot be
    /// had becomes a checker in magenta and black, with a warning.
    Found find(const std::string& name);

    /// Mean of a picture of numbers, each 0..1, such as a roughness map; nothing, and a warning, if it cannot be had.
    std::optional<Vec3f> mean_value(const std::string& name);
    /// Mean colour of a picture, linear; nothing, and a warning, if it cannot be had.
    std::optional<Vec3f> mean_colour(const std::string& name);

private:
    std::optional<DecodedImage> decode(const std::string& name);
    std::optional<Vec3f> mean(const std::string& name, bool is_colour);

    Scene& scene_;
    const aiScene* content_;
    const std::string& path_;
    const ImageReader& read_image_;
    std::map<std::string, Found> found_;
    std::map<std::pair<std::string, bool>, std::optional<Vec3f>> means_;
};

}  // namespace realcam::io
