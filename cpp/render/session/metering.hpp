#pragma once
#include "../../camera/film/camera.hpp"
#include "../../platform.hpp"
#include "../../scene/assembly.hpp"
#include "../film/image.hpp"
#include "../settings/render_settings.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the mean exposure (luminance) of a picture, lux seconds; 0 for a black picture. Pixels without any light (a
/// black background) do not count, and no pixel counts for more than eight times the mean (three stops). Emitters and
/// the sun's mirror image are therefore overexposed, as on a sensor.
double metered_exposure(const Image& image);

/// Returns the exposure time, s, with which the mean exposure of the camera's picture is middle grey (10 lx s / ISO).
/// Takes a picture of at most 96 x 96 pixels to measure it. Throws InputError if no light reaches the film, and what
/// take_picture throws.
double metered_exposure_time(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                             const Progress& progress);

}  // namespace REALCAM_NAMESPACE
