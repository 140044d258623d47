#pragma once
#include "../../render/film/image.hpp"
#include "../typed_object.hpp"

namespace realcam::bindings {

/// Returns the fields of a Python Image by name: among them a dict of the requested layers, and the names of objects
/// and materials by their ids.
PictureFields picture_from(Image image, LayerSet layers);

}  // namespace realcam::bindings
