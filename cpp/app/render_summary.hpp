#pragma once
#include <string>

#include "../render/backend.hpp"
#include "render_options.hpp"

namespace realcam::app {

/// What was photographed and what it cost, some lines. `seconds`: wall clock of everything.
std::string summary(const RenderRequest& request, const Image& image, double seconds);

}  // namespace realcam::app
