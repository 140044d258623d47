#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include "../camera/camera_key.hpp"
#include "../camera/shake.hpp"
#include "../render/session.hpp"

namespace realcam::shot {

/// The time at which the shutter of a frame of a film opens. That of frame 1 opens when the camera's own does.
double frame_opens_s(const Camera& camera, int number, double frames_per_second);

/// The camera of a picture that begins at a time, of one whose rings follow keys and that is held by hand: rings and
/// dials stay as they are when the shutter opens, and the shake is that of the exposure. Throws InputError.
Camera camera_at(Camera camera, const std::vector<CameraKey>& keys, const Shake& shake, double opens_s);

/// The frames of a film by which its effects are planned: the first, the middle and the last one, and the first one
/// after each cut to another lens. numbers: of all frames, at least one.
std::vector<int> frames_to_plan(const std::vector<int>& numbers, const Camera& camera,
                                const std::vector<CameraKey>& keys, double frames_per_second);

/// The seed of a frame: no two frames of a shot have the same. Shots whose seeds are neighbours share none by rule.
std::uint32_t frame_seed(std::uint32_t seed, int number);

/// The ISO numbers of frames whose exposure follows the meter, as a camera's does: a mean over what was metered up to
/// the frame, in stops, whose weights fall with exp(-age / smoothing). Frames before the first are none. A function of
/// the frame alone, whichever frames were asked for before.
class FollowedIso {
public:
    /// Keeps references: session and scene have to outlive it.
    FollowedIso(Session& session, const Assembly& scene, Camera camera, std::vector<CameraKey> keys,
                RenderSettings settings, double frames_per_second, double smoothing_s);

    /// Throws InputError, also where no light reaches the film; Cancelled.
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
