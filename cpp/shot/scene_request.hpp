#pragma once
#include <array>
#include <string>
#include <vector>

#include "../scene/assembly.hpp"

namespace realcam::shot {

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
