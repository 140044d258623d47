#pragma once
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// A whole picture, from its first sample on, and what it cost. Throws InputError for a camera, scene or settings that
/// make no picture, Cancelled, and DeviceError. If `progress` stops a picture of which each pixel has samples, and
/// `finishes` returns true then and until the picture is finished, the samples that were taken are the picture, and
/// Image::shortfall says so. Without `finishes` a stopped picture is given up.
Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress, const KeepGoing& finishes = {});

}  // namespace REALCAM_NAMESPACE
