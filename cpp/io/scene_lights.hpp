#pragma once
#include "../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// The punctual lights of a glTF file, intensity in cd, illuminance in lux; other formats have none. From the file's
/// own JSON: assimp knows one node for each light only, and finds it by name.
void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
