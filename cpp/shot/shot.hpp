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

/// A scene in its light, and the camera that photographs it.
struct Shot {
    Assembly scene;
    Camera camera;
    std::optional<SceneCamera> scene_camera;  ///< of the scene's file, whose view was taken
    bool has_daylight = false;  ///< chosen, because the scene brings no light
    bool is_metered = false;    ///< the exposure time was chosen
};

/// Reads the lenses of the keys, with the blades of the request. Where keys zoom its lens, they get the f-number of the
/// request, which the lens need not reach at the position that it had before. Throws InputError and LensFileError.
void settle_keys(ShotRequest& request);

/// Lens, film and dials of a request whose keys are settled, before the camera is placed. Throws InputError and
/// LensFileError for all that can be found wrong before the scene is read: nobody should wait for a picture and be told
/// then.
Camera camera_of(const ShotRequest& request);

/// The scene of a request in the environment of the request. Throws InputError, SceneFileError and ImageFileError, and
/// Cancelled where `keep_going` returns false.
Assembly scene_of(const ShotRequest& request, const PictureReaders& readers, const KeepGoing& keep_going = {});

/// The same of a scene that is in memory, in place of the request's file.
Assembly scene_of(const ShotRequest& request, Assembly scene, const PictureReaders& readers,
                  const KeepGoing& keep_going = {});

/// Places and focuses the camera as asked for, and otherwise as set_view says; brings daylight where there is no light.
/// An environment that was asked for counts as light even where it is dark. Throws InputError.
Shot set_up(const ShotRequest& request, Camera camera, Assembly scene);

/// The camera of the scene whose view a shot has, and how its lens differs; empty where it has none.
std::string view_notice(const Shot& shot);

/// Sets the exposure time, unless the request has one, from a quick picture with the settings of the request (see
/// metered_exposure_time).
void meter(Shot& shot, const ShotRequest& request, Session& session, const Progress& progress);

}  // namespace realcam::shot
