#include "metering.hpp"

#include <algorithm>
#include <cmath>

#include "../../optics/coating/coated_surface.hpp"
#include "../settings/effect_names.hpp"
#include "take_picture.hpp"

namespace realcam {

double metered_exposure(const Image& image) {
    // Mean over the lit pixels of the luminance, limited to `limit`.
    const auto mean_up_to = [&](double limit) {
        double sum = 0, count = 0;
        for (std::size_t i = 0; i + 2 < image.exposure.size(); i += 3) {
            const float* rgb = &image.exposure[i];
            const double y = 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) +
                             0.0722 * static_cast<double>(rgb[2]);
            if (!(y > 0)) continue;
            sum += std::min(y, limit);
            ++count;
        }
        return count > 0 ? sum / count : 0.0;
    };
    // The limit depends on the mean: a fixed-point iteration.
    constexpr double kMaxOverMean = 8;
    double mean = mean_up_to(1e300);
    for (int i = 0; i < 20; ++i) mean = mean_up_to(kMaxOverMean * mean);
    return mean;
}

double metered_exposure_time(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                             const Progress& progress) {
    constexpr double kLongSide = 96;
    Film& film = camera.film;
    const double scale = std::min(1.0, kLongSide / std::max(film.width, film.height));
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
    camera.exposure_time_s = 1;
    settings.spp = 16;
    settings.noise.reset();
    settings.layers = {};
    if (settings.effects.is_automatic) {  // the planner's choice depends on the exposure time
        EffectChoice effects;
        // Coatings are simulated if they are known, because they change the light that reaches the film.
        const bool is_named = (settings.effects.named & bit_of(*find_effect("coatings"))) != 0;
        effects.coatings =
            is_named ? settings.effects.coatings
                     : camera.model == CameraModel::full_lens && surfaces_with_unknown_coating(camera.lens).empty();
        settings.effects = effects;
        settings.remove_spectra();
    }
    const double per_second = metered_exposure(take_picture(session, scene, camera, settings, progress));
    if (!(per_second > 0) || !std::isfinite(per_second))
        throw InputError("no light reaches the film, so that no exposure can be metered; specify an exposure time");
    constexpr double kMiddleGrey = 10;  // lux seconds times ISO
    return kMiddleGrey / (camera.iso * per_second);
}

}  // namespace realcam
