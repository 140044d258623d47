#pragma once
#include "../../shot/shot.hpp"

namespace realcam::bindings {

/// Returns the picture readers of realcam._pictures, which links OpenImageIO. The texture reader may be called without
/// the GIL. They throw ImageFileError if this build of realcam lacks that module.
shot::PictureReaders picture_readers();

}  // namespace realcam::bindings
