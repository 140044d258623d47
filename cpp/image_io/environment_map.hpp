#pragma once
#include "../keep_going.hpp"
#include "../scene/scene.hpp"
#include "open_picture.hpp"

namespace realcam::image_io {

/// The pixels of a file as an environment: OpenEXR's latitude-longitude map turned round, so that its middle column
/// lies towards +z, and its cube map as a latitude-longitude picture. Throws Error where a cube map is none, and
/// Cancelled.
Environment environment_of(EnvironmentMap map, Environment file, const KeepGoing& keep_going);

}  // namespace realcam::image_io
