#pragma once
#include <optional>
#include <string>

#include "../render/progress.hpp"
#include "../scene/assembly.hpp"
#include "picture_readers.hpp"
#include "shot_request.hpp"

namespace realcam {
class Session;
}

namespace realcam::shot {

/// A scene with its lights, and the camera that photographs it.
struct Shot {
    Assembly scene;
    Camera camera;
    std::optional<SceneCamera> scene_camera;  ///< camera of the scene's file whose view was taken
    bool has_daylight = false;  ///< added because the scene has no light
    bool is_metered = false;    ///< true if the exposure time was metered
};

/// Reads the lenses of the keys, with the blades of the request. If keys zoom the request's lens, they get its
/// f-number, which the lens need not reach at its initial zoom position. Throws InputError and LensFileError.
void resolve_keys(ShotRequest& request);

/// Lens, film and dials of a request after resolve_keys, before the camera is placed. Throws InputError and
/// LensFileError for all errors that can be found before the scene is read, which may take long.
Camera camera_of(const ShotRequest& request);

/// Reads the scene of a request, with the environment of the request. Throws InputError, SceneFileError and
/// ImageFileError, and Cancelled if `keep_going` returns false.
Assembly scene_of(const ShotRequest& request, const PictureReaders& readers, const KeepGoing& keep_going = {});

/// scene_of for a scene in memory, in place of the request's file.
Assembly scene_of(const ShotRequest& request, Assembly scene, const PictureReaders& readers,
                  const KeepGoing& keep_going = {});

/// Places and focuses the camera as requested, and otherwise as set_view does; adds daylight if there is no light. A
/// requested environment counts as light even if it is black. Throws InputError.
Shot set_up(const ShotRequest& request, Camera camera, Assembly scene);

/// Notice on the scene's camera whose view a shot takes, and on the lens's different field; empty for other views.
std::string view_notice(const Shot& shot);

/// Meters the exposure time, unless the request has one, by a quick picture with the settings of the request (see
/// metered_exposure_time).
void meter(Shot& shot, const ShotRequest& request, Session& session, const Progress& progress);

}  // namespace realcam::shot
