#pragma once
#include "../../shot/shot.hpp"

namespace realcam::bindings {

/// Returns the readers of textures and environment maps, which use OpenImageIO's Python package. The texture reader may
/// be called without the GIL. They throw ImageFileError if this build of realcam cannot read image files.
shot::PictureReaders picture_readers();

}  // namespace realcam::bindings
