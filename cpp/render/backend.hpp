#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "../scene/assembly.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxThreads = 4096;  ///< more than machines have cores; TBB falls over what is far beyond

struct RenderSettings {
    int spp = 64;  ///< samples per pixel
    std::uint32_t seed = 0;
    int max_bounces = 0;  ///< 0: direct light only
    int threads = 0;      ///< 0: all
};

/// What a picture cost. Seconds of the stages are summed over the threads.
struct RenderStats {
    double seconds = 0;        ///< wall clock, all of it
    double setup_seconds = 0;  ///< pupil and scene, part of the above
    double lens_seconds = 0, scene_seconds = 0, other_seconds = 0;
    std::uint64_t sampled_rays = 0;  ///< sent into the lens
    std::uint64_t passed_rays = 0;   ///< that left it
    std::uint64_t scene_rays = 0;    ///< camera, shadow and bounce rays traced in the scene
    std::string device;
};

/// A noiseless exposure, as it lies on the film.
struct Image {
    int width = 0, height = 0;
    std::vector<float> exposure;  ///< height * width * 3, lux seconds, linear Rec. 709
    std::vector<float> depth;     ///< height * width, metres along the axis from the film; infinite: nothing there
    int spp = 0;                  ///< samples per pixel that it holds
    RenderStats stats;
};

/// Called about 20 times a second on the thread that called render. `done` goes from 0 to 1; returns false to stop.
using Progress = std::function<bool(double done)>;

/// A device that takes pictures.
class Backend {
public:
    virtual ~Backend() = default;
    virtual std::string name() const = 0;

    /// Throws InputError for a camera, scene or settings that make no picture, Cancelled, and DeviceError.
    virtual Image render(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                         const Progress& progress) = 0;
};

/// Throws InputError where the settings make no sense.
inline void validate(const RenderSettings& settings) {
    if (settings.spp < 1 || settings.spp > (1 << 24)) throw InputError("spp must lie between 1 and 16777216");
    if (settings.max_bounces < 0 || settings.max_bounces > 64)
        throw InputError("max_bounces must lie between 0 and 64");
    if (settings.threads < 0 || settings.threads > kMaxThreads)
        throw InputError("threads must be 0 (all) or a number up to " + std::to_string(kMaxThreads));
}

}  // namespace REALCAM_NAMESPACE
