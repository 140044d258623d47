#include "camera_gradient.hpp"

#include <cmath>
#include <utility>

#include "../../scene/scene_checks.hpp"

namespace realcam {

namespace {

/// Throws InputError for a feature of the camera or the settings that derivatives do not support.
void check_supported(const Camera& camera, const RenderSettings& settings) {
    const auto refuse = [](const std::string& what) { throw InputError("derivatives of pictures " + what); };
    if (settings.filter == PixelFilter::box)
        refuse("need a smooth pixel filter, tent or gaussian; that of the box is a delta function at its edges");
    if (camera.model != CameraModel::full_lens) refuse("need the camera model full");
    if (camera.geometry) refuse("do not support calibrated cameras");
    if (camera.moves()) refuse("do not support cameras that move during the exposure");
    for (const EffectInfo& effect : kEffects)
        if (settings.effects.*effect.member && !effect.is_on() && effect.member != &EffectChoice::dispersion)
            refuse(std::string("do not support the effect ") + effect.name);
    if (settings.pupil_sampling != PupilSampling::outline) refuse("need the pupil sampling outline");
}

/// Returns the film of a picture, with a margin as wide as the filter.
GradientFilm gradient_film(const Film& film, PixelFilter filter) {
    return {film.width, film.height, static_cast<int>(std::ceil(filter_radius(filter) - 0.5f))};
}

/// Camera whose film extends past the picture's border by the pixels of the margin, from which light counts for pixels
/// at the border.
Camera extended(Camera camera, int margin) {
    Film& film = camera.film;
    film.width_mm *= static_cast<double>(film.width + 2 * margin) / film.width;
    film.height_mm *= static_cast<double>(film.height + 2 * margin) / film.height;
    film.width += 2 * margin;
    film.height += 2 * margin;
    return camera;
}

/// Effects of the samples' camera, which are uniform on the extended film.
LensEffects sample_effects(const RenderSettings& settings) {
    LensEffects effects = settings.lens_effects();
    effects.pixel_filter = PixelFilter::box;
    return effects;
}

}  // namespace

CameraGradient::CameraGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                               std::vector<LensVariable> variables, const PupilTracer& tracer)
    : camera_((validate(camera), check_supported(camera, settings), camera)),
      settings_(settings),
      film_(gradient_film(camera.film, settings.filter)),
      path_(camera.lens, camera.lens.wavelength_nm, std::move(variables)),
      outline_(camera.lens, camera.lens.wavelength_nm),
      setup_(std::make_shared<const CameraSetup>(extended(camera, film_.margin), tracer, nullptr,
                                                 sample_effects(settings))) {
    SceneChecks().check(scene);
    if (scene.moves() && camera.shutter.readout_time_s > 0)
        throw InputError("derivatives of pictures do not support rolling shutters in scenes that move");
}

std::vector<float> CameraGradient::adjoint_of_control(const float* adjoint, const float* control) const {
    if (!control) return {};
    std::vector<float> sums(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
    for (float& sum : sums) {
        sum = adjoint[0] * control[0] + adjoint[1] * control[1] + adjoint[2] * control[2];
        adjoint += 3, control += 3;
    }
    return sums;
}

double CameraGradient::exposure_per_sample(int spp) const {
    return camera_.exposure_time_s * settings_.filter_transmittance() / spp;
}

Vec2d CameraGradient::pixels_per_mm() const {
    return {-camera_.film.width / camera_.film.width_mm, camera_.film.height / camera_.film.height_mm};
}

std::vector<double> CameraGradient::by_all_numbers(const CameraDerivatives& by, double by_stop, double by_rims) {
    std::vector<double> list = by.by_variable;
    list.insert(list.end(), by.by_film.begin(), by.by_film.end());
    list.insert(list.end(), by.by_pose.begin(), by.by_pose.end());
    list.push_back(by_stop);
    list.push_back(by_rims);
    return list;
}

}  // namespace realcam
