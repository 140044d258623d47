#pragma once
#include <array>
#include <string>
#include <vector>

#include "../scene/assembly.hpp"

namespace realcam::shot {

// What a shot file adds to the scene that it photographs. `place` is where the file says so, for messages.

struct MaterialRequest {
    std::string name, place;
    Material values;
    /// Files, in the order of kMaterialTextures; empty: none.
    std::array<std::string, kMaterialTextures.size()> textures;
};

/// Another file, put into the scene.
struct ObjectRequest {
    std::string file, name, place;
    double scale = 1;  ///< metres per unit of the file
    Placement placement;
    std::string material;  ///< for all of it; empty: its own
};

struct SceneRequest {
    std::vector<MaterialRequest> materials;
    std::vector<ObjectRequest> objects;
    std::vector<ScenePointLight> points;
    std::vector<SunLight> suns;
};

}  // namespace realcam::shot
