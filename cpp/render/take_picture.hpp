#pragma once
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// A whole picture, from its first sample on, and what it cost. Throws InputError for a camera, scene or settings that
/// make no picture, Cancelled, and DeviceError.
Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress);

}  // namespace REALCAM_NAMESPACE
