#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "../io/scene_file.hpp"
#include "../scene/assembly.hpp"

namespace realcam::shot {

/// Functions that decode picture files. The programs supply those of image_io.
struct PictureReaders {
    io::ImageReader texture;  ///< reads a texture
    /// Reads an environment. `layer`: name of an OpenEXR layer, or empty. `to_rec709`: conversion of its colours, or
    /// empty: as the file states. `warn`: receives the reader's warnings.
    std::function<Environment(const std::string& path, const std::string& layer, const io::ColorConversion& to_rec709,
                              const std::function<void(const std::string&)>& warn)>
        environment;
};

// Additions of a shot file to the scene that it photographs. `location`: position in the shot file, for messages.

/// Table [material.NAME]: replaces the materials of this name.
struct MaterialRequest {
    std::string name, location;
    Material values;
    /// Files, in the order of kMaterialTextures; empty: no texture.
    std::array<std::string, kMaterialTextures.size()> textures;
};

/// Table [[object]]: another scene file that is placed in the scene.
struct ObjectRequest {
    std::string file, name, location;
    double scale = 1;  ///< metres per unit of the file
    AnimatedTransform placement;
    std::string material;  ///< replaces all materials of the file; empty: keeps them
};

/// All additions of a shot file to its scene.
struct SceneRequest {
    std::vector<MaterialRequest> materials;
    std::vector<ObjectRequest> objects;
    std::vector<ScenePointLight> points;
    std::vector<SunLight> suns;
};

}  // namespace realcam::shot
