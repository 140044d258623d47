#pragma once
#include <string>
#include <vector>

#include "../render/image.hpp"
#include "../shot/shot.hpp"

namespace realcam::app {

/// What was photographed, and how long it took, some lines. `seconds`: wall clock of everything. `verbose`: also rays
/// per second, and where the time went. `denoiser`: its name; empty: there was none.
std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose);

/// A line on a frame of a film.
std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures);

}  // namespace realcam::app
