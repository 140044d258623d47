#pragma once
#include <pybind11/pybind11.h>

#include "../optics/prescription/coating.hpp"

namespace realcam::bindings {

/// A coating as users write it: the name of one that has a name, or a Coating. Throws InputError.
Coating coating_from(const pybind11::object& coating);

}  // namespace realcam::bindings
