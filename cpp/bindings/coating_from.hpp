#pragma once
#include <pybind11/pybind11.h>

#include "../optics/prescription/coating.hpp"

namespace realcam::bindings {

/// Converts the name of a known coating or a Coating. Throws InputError.
Coating coating_from(const pybind11::object& coating);

}  // namespace realcam::bindings
