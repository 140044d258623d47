#pragma once
#include "../../scene/scene.hpp"
#include "scene_part.hpp"

namespace realcam::io {

/// Adds the punctual lights of a glTF file, with intensities in cd and illuminances in lux; other formats have no
/// lights.
void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out);

}  // namespace realcam::io
