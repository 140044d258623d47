#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../camera/film/camera_key.hpp"
#include "../camera/film/shake.hpp"
#include "../render/session/progress.hpp"
#include "../render/session/session.hpp"
#include "../scene/assembly.hpp"
#include "scene_request.hpp"
#include "shot_request.hpp"

namespace realcam::shot {

/// Time in s at which the shutter of a video's frame opens. For frame 1 this is the camera's own opening time.
double frame_opens_s(const Camera& camera, int number, double frames_per_second);

/// Camera for a picture whose shutter opens at `opens_s`: with the lens and exposure settings of the keyframes at that
/// time, and with the hand shake during the exposure. Throws InputError.
Camera camera_at(Camera camera, const std::vector<CameraKey>& keys, const Shake& shake, double opens_s);

/// Frames of a video from which its effects are planned: the first, the middle and the last one, and the first one
/// after each cut to another lens. `numbers`: of all frames, at least one.
std::vector<int> frames_to_plan(const std::vector<int>& numbers, const Camera& camera,
                                const std::vector<CameraKey>& keys, double frames_per_second);

/// Random seed of a frame, different for each frame of a shot. `seed`: of the shot. Shots with adjacent seeds do not
/// systematically share frame seeds.
std::uint32_t frame_seed(std::uint32_t seed, int number);

/// Auto-ISO of a video: the ISO number of a frame is the mean, in stops, of the metered ISO numbers of this and earlier
/// frames, with weights exp(-age / smoothing_s). Frames before frame 1 do not count. The result depends on the frame
/// alone, not on earlier calls.
class AutoIso {
public:
    /// `session` and `scene` must outlive this object.
    AutoIso(Session& session, const Assembly& scene, Camera camera, std::vector<CameraKey> keys,
            RenderSettings settings, double frames_per_second, double smoothing_s);

    /// ISO number of a frame. Throws InputError, also if no light reaches the film, and Cancelled.
    double at(int number, const Progress& progress);

private:
    /// ISO number with which a frame alone would be correctly exposed.
    double metered(int number, const Progress& progress);

    Session& session_;
    const Assembly& scene_;
    Camera camera_;
    std::vector<CameraKey> keys_;
    RenderSettings settings_;
    double frames_per_second_, smoothing_s_;
    std::map<int, double> metered_;  ///< results of metered, by frame
};

}  // namespace realcam::shot

namespace realcam::shot {

/// A scene with its lights, and the camera that photographs it.
struct Shot {
    Assembly scene;
    Camera camera;
    std::optional<SceneCamera> scene_camera;  ///< camera of the scene file whose view is used; std::nullopt: none
    bool has_daylight = false;  ///< added because the scene has no light
    bool is_metered = false;  ///< true if the exposure time was metered
};

/// Reads the lenses of the keyframes, and gives them the blades of the request. If keyframes zoom the request's lens,
/// its f-number is moved to the first keyframe, because the lens need not reach it at its initial zoom position. Throws
/// InputError and LensFileError.
void resolve_keys(ShotRequest& request);

/// Returns the view that develops the picture: a view of the request's OpenColorIO configuration, or its tone curve.
/// Throws InputError.
std::shared_ptr<const View> view_of(const ShotRequest& request);

/// Lens, film and dials of a request after resolve_keys, before the camera is placed. Changes focus distances of the
/// request that are measured to the lens's entrance pupil to those to its film. Throws InputError and LensFileError for
/// all errors that can be found before the scene is read, which may take long.
Camera camera_of(ShotRequest& request);

/// Reads the scene of a request, with its additions, texture and environment. Throws InputError, SceneFileError and
/// ImageFileError, and Cancelled if `keep_going` returns false.
Assembly scene_of(const ShotRequest& request, const PictureReaders& readers, const KeepGoing& keep_going = {});

/// scene_of for a scene in memory instead of the request's file.
Assembly scene_of(const ShotRequest& request, Assembly scene, const PictureReaders& readers,
                  const KeepGoing& keep_going = {});

/// Places and focuses the camera as requested, and otherwise as set_view does; adds daylight if there is no light. A
/// requested environment counts as light even if it is black. Throws InputError.
Shot set_up(const ShotRequest& request, Camera camera, Assembly scene);

/// Notice that names the scene's camera whose view a shot uses, and compares its field of view with the lens's; empty
/// for other views.
std::string view_notice(const Shot& shot);

/// Meters the exposure time, unless the request has one, by a quick picture with the settings of the request (see
/// metered_exposure_time).
void meter(Shot& shot, const ShotRequest& request, Session& session, const Progress& progress);

}  // namespace realcam::shot
