#pragma once
#include <pybind11/pybind11.h>

#include "../../render/film/image.hpp"

namespace realcam::bindings {

/// Returns the fields of a Python Image by name: among them a dict of the requested layers, and the names of objects
/// and materials by their ids.
pybind11::dict picture_from(Image image, LayerSet layers);

}  // namespace realcam::bindings
