#pragma once
#include <string>
#include <vector>

#include "../render/image.hpp"
#include "../shot/shot.hpp"

namespace realcam::app {

/// The figures of a picture that was taken, for programs; null where a number is infinite or does not exist. `plan`:
/// what the effect "auto" has decided, in a line; empty: it was not asked. `denoiser`: its name; empty: there was none.
/// `warnings`: what was told on the way.
std::string render_as_json(const shot::Shot& shot, const shot::ShotRequest& request, const Image& image,
                           const std::vector<std::string>& pictures, const std::string& plan,
                           const std::string& denoiser, const std::vector<std::string>& warnings, double seconds);

}  // namespace realcam::app
