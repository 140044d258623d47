#pragma once
#include <array>

#include "../platform.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the linear value, 0 to 1, of each 8-bit code. Host only.
std::array<float, 256> light_of_codes(TextureEncoding encoding);

}  // namespace REALCAM_NAMESPACE
