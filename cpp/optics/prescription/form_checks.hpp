#pragma once
#include <string>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the reason why a surface's form or aperture shape is invalid; empty if it is valid.
std::string form_error(const Surface& surface);

/// Makes the checks of a surface's shape that do not depend on a lens. Throws InputError.
void validate(const Surface& surface);

}  // namespace REALCAM_NAMESPACE
