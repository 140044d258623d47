#pragma once
#include <string>

#include "../scene/scene.hpp"
#include "scene_import.hpp"

namespace realcam::io {

/// The punctual lights of a glTF file, intensity in cd, illuminance in lux; other formats have none. From the file's
/// own JSON: assimp knows one node for each light only, and finds it by name. `scale`: metres per unit of the file.
void read_lights(Scene& scene, const ImportedScene& file, const std::string& path, double scale);

}  // namespace realcam::io
