#pragma once
#include <string>
#include <vector>

#include "../plan/plan.hpp"
#include "../render/film/image.hpp"
#include "../shot/shot.hpp"

namespace realcam::app {

/// Plan as a JSON object; null stands for a number that is infinite or does not exist.
std::string json_of(const Plan& plan);

/// Settings and cost of a picture as a JSON object; null stands for a number that is infinite or does not exist.
/// `view`: develops the picture. `pictures`: files that were written. `plan`: one-line summary of the planner's
/// decisions, empty without a plan. `denoiser`: its name, empty if the picture was not denoised. `warnings`: those that
/// were printed. `seconds`: wall-clock time of the whole command.
std::string render_as_json(const shot::Shot& shot, const shot::ShotRequest& request, const View& view,
                           const Image& image, const std::vector<std::string>& pictures, const std::string& plan,
                           const std::string& denoiser, const std::vector<std::string>& warnings, double seconds);

}  // namespace realcam::app
