#pragma once
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// Takes a picture from scratch, with settings.spp samples per pixel or up to settings.noise, and measures its cost.
/// Throws InputError if camera, scene or settings are invalid, and DeviceError.
///
/// `progress` may stop the picture by returning false. `keep_partial` is then asked: if it returns true and each pixel
/// has samples, the picture is developed from the samples so far, and Image::shortfall says so. Otherwise, and if
/// `keep_partial` is empty, or returns false while the picture is developed, Cancelled is thrown.
Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress, const KeepGoing& keep_partial = {});

}  // namespace REALCAM_NAMESPACE
