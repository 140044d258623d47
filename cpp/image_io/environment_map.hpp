#pragma once
#include "../checkpoint.hpp"
#include "../scene/scene.hpp"
#include "open_picture.hpp"

namespace realcam::image_io {

/// Converts the pixels of a file to an environment: rotates OpenEXR's latitude-longitude map, whose middle column lies
/// towards +z, and resamples a cube map to a latitude-longitude picture. Throws Error if a cube map does not consist of
/// six squares, and Cancelled.
Environment environment_of(EnvironmentMap map, Environment file, const KeepGoing& keep_going);

}  // namespace realcam::image_io
