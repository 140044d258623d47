#pragma once
#include "../shot/shot.hpp"

namespace realcam::bindings {

/// The readers of realcam._pictures, which links OpenImageIO. That of textures may be called without the interpreter's
/// lock. They throw ImageFileError where this build of realcam has no such module.
shot::PictureReaders picture_readers();

}  // namespace realcam::bindings
