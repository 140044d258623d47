#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// The punctual lights of a glTF file, intensity in cd, illuminance in lux; other formats have none.
void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
