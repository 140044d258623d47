#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// How light is followed through the scene.
enum class LightTransport : std::int32_t {
    paths,    ///< all ways of light, by path tracing (Kajiya 1986)
    whitted,  ///< direct light, and what mirrors and smooth glass show (Whitted 1980)
};

/// How the images of lights are found that are small, or out of focus (trace_lights.hpp).
enum class LightTracing : std::int32_t {
    weighted,  ///< by samples of pixels and by samples from the lights, each weighted by the densities of both
    off,       ///< by samples of pixels alone, which never meet points and suns
    alone,     ///< by samples from the lights alone, to compare
};

struct PathSettings {
    std::int32_t max_bounces = 0;  ///< after which a path ends; 0: direct light only
    LightTransport transport = LightTransport::paths;
    float clamp = 0;  ///< radiance above which what a path brings after its first hit is cut off, cd/m^2; 0: never

    constexpr bool operator==(const PathSettings&) const = default;
};

/// Whether all lobes of a surface send out rays. After the last bounce, one more ray looks for the light that narrow
/// lobes show.
REALCAM_INLINE bool goes_on(const PathSettings& settings, int bounce) {
    return bounce < settings.max_bounces && settings.transport == LightTransport::paths;
}

}  // namespace REALCAM_NAMESPACE
