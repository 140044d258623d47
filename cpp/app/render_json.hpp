#pragma once
#include <string>
#include <vector>

#include "../plan/plan.hpp"
#include "../render/film/image.hpp"
#include "../shot/shot.hpp"

namespace realcam::app {

/// Plan as JSON; null if a number is infinite or does not exist.
std::string json_of(const Plan& plan);

/// Figures of a picture as JSON; null if a number is infinite or does not exist. `plan`: one-line summary of what the
/// effect "auto" decided, empty without it. `denoiser`: its name, empty if the picture was not denoised. `warnings`:
/// those that were printed.
std::string render_as_json(const shot::Shot& shot, const shot::ShotRequest& request, const Image& image,
                           const std::vector<std::string>& pictures, const std::string& plan,
                           const std::string& denoiser, const std::vector<std::string>& warnings, double seconds);

}  // namespace realcam::app
