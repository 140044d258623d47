#pragma once
#include <string>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../render/image.hpp"

namespace realcam::app {

/// How many stops the metered light of a picture lies above middle grey; -infinity where there is none.
double stops_above_grey(const Image& image, double iso);

/// A sentence about a picture of which, once it is developed, hardly anything is to be seen: nearly all of it is black
/// or white. By how much, and what to change. Empty for any other picture.
std::string exposure_notice(const Image& image, const Camera& camera, ToneCurve tone);

}  // namespace realcam::app
