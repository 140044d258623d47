#pragma once
#include <string>

#include "surface.hpp"

namespace REALCAM_NAMESPACE {

/// Why a surface's form, or the shape of its aperture, is one that cannot be; empty: it can.
std::string form_error(const Surface& surface);

}  // namespace REALCAM_NAMESPACE
