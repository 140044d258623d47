#pragma once
#include <string>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the reason why a surface's form or aperture shape is invalid; empty if it is valid.
std::string form_error(const Surface& surface);

}  // namespace REALCAM_NAMESPACE
