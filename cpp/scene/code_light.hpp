#pragma once
#include <array>

#include "../platform.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// What each code of 8 bits stands for, 0 to 1, linear. On the host.
std::array<float, 256> light_of_codes(TextureEncoding encoding);

}  // namespace REALCAM_NAMESPACE
