#pragma once
#include "../../render/film/image.hpp"
#include "../typed_object.hpp"

namespace realcam::bindings {

/// Returns the attributes of a realcam.Image by name. "layers" is a dict of the requested layers' arrays;
/// "object_names" and "material_names" are tuples indexed by the ids in those layers.
PictureFields picture_from(Image image, LayerSet layers);

}  // namespace realcam::bindings
