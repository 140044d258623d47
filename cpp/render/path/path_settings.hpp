#pragma once
#include <cstdint>

#include "../../camera/models/camera_view.hpp"
#include "../../platform.hpp"
#include "../../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Kind of scene for which the kernels of a picture are compiled.
inline SceneKind kind_of(const SceneView& scene, const CameraView& camera) {
    return camera.key_count > 0 ? SceneKind::any : scene.kind;
}

/// Kind of lens for which the kernels are compiled. Methods that only serve for comparison, pixel pupils and the
/// polynomial model, are left out of the code for plain lenses.
inline LensKind lens_kind_of(const CameraView& camera) {
    if (has_any_lens(camera)) return LensKind::any;
    const bool compares = camera.pixel_pupils.known || camera.model == CameraModel::polynomial_lens;
    return compares && camera.lens.kind == LensKind::plain ? LensKind::rotational : camera.lens.kind;
}

/// Transport of light through the scene.
enum class LightTransport : std::int32_t {
    paths,    ///< all light paths, by path tracing (Kajiya 1986)
    whitted,  ///< direct light, and specular reflection and transmission (Whitted 1980)
};

/// Sampling of the images of lights that are small or out of focus (trace_lights.hpp).
enum class LightTracing : std::int32_t {
    weighted,  ///< by samples of pixels and by samples from the lights, each weighted by the densities of both
    off,       ///< by samples of pixels alone, which never hit points and suns
    alone,     ///< by samples from the lights alone, for comparison
};

struct PathSettings {
    std::int32_t max_bounces = 0;  ///< bounces after which a path ends; 0: direct light only
    LightTransport transport = LightTransport::paths;
    float clamp = 0;  ///< largest radiance that a path adds after its first hit, cd/m^2; 0: no limit

    constexpr bool operator==(const PathSettings&) const = default;
};

/// True if all lobes of a surface send out rays. After the last bounce, one more ray finds the light that narrow lobes
/// show.
REALCAM_INLINE bool goes_on(const PathSettings& settings, int bounce) {
    return bounce < settings.max_bounces && settings.transport == LightTransport::paths;
}

}  // namespace REALCAM_NAMESPACE
