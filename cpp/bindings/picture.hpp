#pragma once
#include <pybind11/pybind11.h>

#include "../render/image.hpp"

namespace realcam::bindings {

/// What the core says of an Image, by the names of its fields: a dict of the layers that were asked for among them, and
/// the names of objects and materials by their ids.
pybind11::dict picture_from(Image image, LayerSet layers);

}  // namespace realcam::bindings
