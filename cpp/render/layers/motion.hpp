#pragma once
#include <optional>
#include <vector>

#include "../../camera/effects/effects.hpp"
#include "../../camera/film/camera.hpp"
#include "../../scene/assembly.hpp"
#include "layer_sum.hpp"
#include "layers.hpp"

namespace REALCAM_NAMESPACE {

struct SceneAndCamera {
    Assembly scene;
    Camera camera;
};

/// Scene and camera for a picture that leaves out motion blur or the rolling shutter. Returns std::nullopt if it leaves
/// out neither, which saves each frame a copy.
std::optional<SceneAndCamera> without_left_out_motion(const Assembly& scene, const Camera& camera,
                                                      const EffectChoice& effects);

/// Motion of the surfaces on the rays of the pixel centres: pixels to the right and down by which each moves in the
/// picture while its pixel is exposed. 0 if nothing moves; NaN if the surface leaves the image circle or no ray passes.
/// `placed_camera`: with arrays on the host, in a scene that was placed about `origin_m`.
LayerImage motion_vectors(const std::vector<PixelCentreSurface>& film, const Assembly& scene, const Camera& camera,
                          const CameraView& placed_camera, Vec3d origin_m);

}  // namespace REALCAM_NAMESPACE
