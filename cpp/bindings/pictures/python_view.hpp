#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "../../render/film/view.hpp"

namespace realcam::bindings {

/// Returns the view of an argument `tone` of Python: the name of a tone curve, or a realcam.OcioView. Requires the GIL.
/// Throws InputError.
std::shared_ptr<const View> view_from(const pybind11::object& tone);

/// Returns the argument from which view_from makes a view. Requires the GIL.
pybind11::object tone_from(const View& view);

/// Registers realcam.ocio as the reader of OpenColorIO's configurations (shot::ocio_reader).
void register_ocio();

}  // namespace realcam::bindings
