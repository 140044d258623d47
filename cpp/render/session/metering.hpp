#pragma once
#include "../../camera/film/camera.hpp"
#include "../../platform.hpp"
#include "../../scene/assembly.hpp"
#include "../film/image.hpp"
#include "../settings/render_settings.hpp"
#include "progress.hpp"
#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// Mean luminance exposure of a picture, lux seconds. Pixels without any light (black background) do not count, and no
/// pixel counts for more than eight times the mean (three stops). So an emitter or the sun's mirror image may be
/// overexposed, as on a sensor. 0 for a black picture.
double metered_exposure(const Image& image);

/// Exposure time with which the average of the camera's picture is middle grey (10 lx s / ISO), metered by a quick
/// picture of at most 96 pixels each way. Throws InputError if no light reaches the film, and what take_picture throws.
double metered_exposure_time(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                             const Progress& progress);

}  // namespace REALCAM_NAMESPACE
