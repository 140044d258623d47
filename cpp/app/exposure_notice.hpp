#pragma once
#include <string>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../render/image.hpp"

namespace realcam::app {

/// Stops by which the metered exposure of a picture lies above middle grey; -infinity for a black picture.
double stops_above_grey(const Image& image, double iso);

/// Warning about a picture that is nearly all black or white once developed: by how many stops it is off, and which
/// settings to change. Empty for any other picture.
std::string exposure_notice(const Image& image, const Camera& camera, ToneCurve tone);

}  // namespace realcam::app
