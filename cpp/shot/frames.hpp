#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "../camera/camera_key.hpp"
#include "../camera/shake.hpp"
#include "../render/session.hpp"

namespace realcam::shot {

/// Time at which the shutter of a frame of a film opens. Frame 1 opens at the camera's own time.
double frame_opens_s(const Camera& camera, int number, double frames_per_second);

/// Camera for a picture that begins at a time, with keyed rings and hand shake. Rings and dials keep their values from
/// when the shutter opens, and the shake is that of the exposure. Throws InputError.
Camera camera_at(Camera camera, const std::vector<CameraKey>& keys, const Shake& shake, double opens_s);

/// Frames of a film from which its effects are planned: the first, the middle and the last one, and the first one after
/// each cut to another lens. numbers: of all frames, at least one.
std::vector<int> frames_to_plan(const std::vector<int>& numbers, const Camera& camera,
                                const std::vector<CameraKey>& keys, double frames_per_second);

/// Seed of a frame, different for all frames of a shot. Shots with adjacent seeds do not systematically share frame
/// seeds.
std::uint32_t frame_seed(std::uint32_t seed, int number);

/// ISO numbers of frames whose exposure follows the meter, as a camera's does: a mean in stops over the metered values
/// up to the frame, with weights that fall with exp(-age / smoothing). Frames before the first do not count. The result
/// depends on the frame alone, not on earlier calls.
class FollowedIso {
public:
    /// Keeps references: session and scene have to outlive it.
    FollowedIso(Session& session, const Assembly& scene, Camera camera, std::vector<CameraKey> keys,
                RenderSettings settings, double frames_per_second, double smoothing_s);

    /// ISO number of a frame. Throws InputError, also if no light reaches the film, and Cancelled.
    double at(int number, const Progress& progress);

private:
    double metered(int number, const Progress& progress);

    Session& session_;
    const Assembly& scene_;
    Camera camera_;
    std::vector<CameraKey> keys_;
    RenderSettings settings_;
    double frames_per_second_, smoothing_s_;
    std::map<int, double> metered_;
};

}  // namespace realcam::shot
