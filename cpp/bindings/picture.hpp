#pragma once
#include <pybind11/pybind11.h>

#include "../render/image.hpp"

namespace realcam::bindings {

/// What realcam.image.image_of makes an Image of: pixels, depth, stats, a dict of the layers that were asked for, and
/// the names of objects and materials by their ids.
pybind11::tuple picture_from(const Image& image, LayerSet layers);

}  // namespace realcam::bindings
