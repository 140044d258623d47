#pragma once
#include <cstdint>

#include "../../camera/models/camera_view.hpp"
#include "../../platform.hpp"
#include "../../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the SceneKind of the kernels that render a picture: that of the scene, or `any` if the camera moves.
inline SceneKind kernel_scene_kind(const SceneView& scene, const CameraView& camera) {
    return camera.key_count > 0 ? SceneKind::any : scene.kind;
}

/// Returns the LensKind of the kernels that render a picture. Kernels for plain (spherical) lenses omit the methods
/// that serve only for comparison, pixel pupils and the polynomial model; with these the kernels for rotationally
/// symmetric lenses are used.
inline LensKind kernel_lens_kind(const CameraView& camera) {
    if (needs_general_lens_code(camera)) return LensKind::any;
    const bool is_comparison = camera.pixel_pupils.known || camera.model == CameraModel::polynomial_lens;
    return is_comparison && camera.lens.kind == LensKind::plain ? LensKind::rotational : camera.lens.kind;
}

/// Transport of light through the scene.
enum class LightTransport : std::int32_t {
    paths,    ///< all light paths, by path tracing (Kajiya 1986)
    whitted,  ///< direct light, and specular reflection and transmission (Whitted 1980)
};

/// Method that samples the images of lights which are small or out of focus (trace_lights.hpp). Pixel samples start at
/// the film; light samples start at the lights.
enum class LightTracing : std::int32_t {
    weighted,  ///< pixel samples and light samples, combined by multiple importance sampling
    off,       ///< pixel samples only, which never hit point lights and suns
    alone,     ///< light samples only, for comparison
};

/// Settings of the path tracer.
struct PathSettings {
    std::int32_t max_bounces = 0;  ///< bounces after which a path ends; 0: direct light only
    LightTransport transport = LightTransport::paths;
    float clamp = 0;  ///< largest radiance that a path adds after its first hit, cd/m^2; 0: no limit

    constexpr bool operator==(const PathSettings&) const = default;
};

/// Returns true if a path continues by sampling all lobes of the surface that it hits at this bounce (0: the first
/// surface). If false, only narrow or mirror lobes are sampled (keep_scattering_lobes in scatter_paths.hpp): the ray
/// then finds the emitters that they reflect, which light samples would find with much noise.
REALCAM_INLINE bool all_lobes_scatter(const PathSettings& settings, int bounce) {
    return bounce < settings.max_bounces && settings.transport == LightTransport::paths;
}

}  // namespace REALCAM_NAMESPACE
