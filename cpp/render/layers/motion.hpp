#pragma once
#include <optional>
#include <vector>

#include "../../camera/effects/effects.hpp"
#include "../../camera/film/camera.hpp"
#include "../../scene/assembly.hpp"
#include "layer_sum.hpp"
#include "layers.hpp"

namespace REALCAM_NAMESPACE {

/// A scene and the camera that photographs it.
struct SceneAndCamera {
    Assembly scene;
    Camera camera;
};

/// Returns copies of scene and camera for a picture without motion blur, rolling shutter, or both. Returns std::nullopt
/// if `effects` includes both, which saves the copies.
std::optional<SceneAndCamera> without_disabled_motion(const Assembly& scene, const Camera& camera,
                                                      const EffectChoice& effects);

/// Returns the motion vectors of the surfaces in `film`: by how many pixels, to the right and down, the image of each
/// surface moves while its pixel is exposed. 0 if nothing moves; NaN if the surface leaves the image circle or no ray
/// passes the lens. `film`: the pixel centres of the whole film, row by row. `placed_camera`: view of the camera with
/// arrays on the host, in the render space whose origin is `origin_m`.
LayerImage motion_vectors(const std::vector<PixelCentreSurface>& film, const Assembly& scene, const Camera& camera,
                          const CameraView& placed_camera, Vec3d origin_m);

}  // namespace REALCAM_NAMESPACE
