#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "../io/scene_file.hpp"
#include "../scene/assembly.hpp"

namespace realcam::shot {

/// Functions that read pictures; the programs supply those of OpenImageIO.
struct PictureReaders {
    io::ImageReader texture;
    /// `layer`: name of an OpenEXR layer, or empty. `warn`: receives what was tolerated in the file.
    std::function<Environment(const std::string& path, const std::string& layer,
                              const std::function<void(const std::string&)>& warn)>
        environment;
};

// Additions of a shot file to the scene that it photographs. `location`: position in the shot file, for messages.

struct MaterialRequest {
    std::string name, location;
    Material values;
    /// Files, in the order of kMaterialTextures; empty: no texture.
    std::array<std::string, kMaterialTextures.size()> textures;
};

/// Another scene file that is placed in the scene.
struct ObjectRequest {
    std::string file, name, location;
    double scale = 1;  ///< metres per unit of the file
    AnimatedTransform placement;
    std::string material;  ///< replaces all materials of the file; empty: keeps them
};

struct SceneRequest {
    std::vector<MaterialRequest> materials;
    std::vector<ObjectRequest> objects;
    std::vector<ScenePointLight> points;
    std::vector<SunLight> suns;
};

}  // namespace realcam::shot
