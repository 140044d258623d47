#pragma once
#include <optional>

#include "../camera/camera.hpp"
#include "../camera/effects.hpp"
#include "../scene/assembly.hpp"

namespace REALCAM_NAMESPACE {

struct SceneAndCamera {
    Assembly scene;
    Camera camera;
};

/// Scene and camera for a picture that leaves out motion blur or the rolling shutter. Returns std::nullopt if it leaves
/// out neither, which saves each frame a copy.
std::optional<SceneAndCamera> without_left_out_motion(const Assembly& scene, const Camera& camera,
                                                      const EffectChoice& effects);

}  // namespace REALCAM_NAMESPACE
