#pragma once
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// Takes a complete picture, and measures its cost. Throws InputError if camera, scene or settings are invalid,
/// Cancelled, and DeviceError. If `progress` stops a picture after each pixel has samples, and `finishes` returns true
/// then and until the picture is complete, the picture consists of the samples that were taken, and Image::shortfall
/// says so. Without `finishes` a stopped picture is discarded.
Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress, const KeepGoing& finishes = {});

}  // namespace REALCAM_NAMESPACE
