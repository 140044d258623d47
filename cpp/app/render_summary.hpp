#pragma once
#include <string>
#include <vector>

#include "../render/image.hpp"
#include "../shot/shot.hpp"

namespace realcam::app {

/// Summary of a picture and its cost, in some lines. `seconds`: wall-clock time of the whole command. `verbose`: adds
/// rays per second, and the time by stage. `denoiser`: its name, empty if the picture was not denoised.
std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose);

/// One-line summary of a frame of a film.
std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures);

}  // namespace realcam::app
