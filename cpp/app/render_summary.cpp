#include "render_summary.hpp"

#include <algorithm>
#include <cstdio>

#include "../io/files/image_metadata.hpp"
#include "../optics/coating/coated_faces.hpp"
#include "../render/effect_names.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

std::string percent(double part, double whole) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f%%", whole > 0 ? 100 * part / whole : 0.0);
    return text;
}

/// A rate in millions per second: "12.3 M".
std::string million(double count, double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f M", seconds > 0 ? 1e-6 * count / seconds : 0.0);
    return text;
}

}  // namespace

std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose) {
    const Camera& camera = shot.camera;
    const LensSystem& lens = camera.lens;
    const Film& film = camera.film;
    const RenderStats& stats = image.stats;
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    std::string text;
    const auto line = [&](std::string what, const std::string& value) {
        what.resize(12, ' ');
        text += what + value + '\n';
    };
    const std::string model = io::name_of(camera.model);
    line("lens", (lens.title.empty() ? lens.name : lens.title) + (model == "full" ? "" : ", as " + model + " model"));
    line("", "focal length " + number_text(data.effective_focal_length) + " mm, f/" + number_text(data.f_number, 3) +
                 (lens.iris.blades > 0 && !lens.is_wide_open() ? " with " + std::to_string(lens.iris.blades) + " blades"
                                                               : "") +
                 ", focus " + distance_text(lens.focus_distance / 1000));
    const Vec3d from = camera.pose.position_m, to = camera.pose.look_at_m;
    const auto point = [](Vec3d p) { return number_text(p.x) + "," + number_text(p.y) + "," + number_text(p.z); };
    line("camera", "at " + point(from) + ", looks at " + point(to));
    line("film", number_text(film.width_mm) + " x " + number_text(film.height_mm) + " mm, " +
                     std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels of " +
                     std::to_string(image.spp) + (image.spp == 1 ? " sample" : " samples"));
    line("exposure", exposure_text(camera.exposure_time_s) + ", ISO " + number_text(camera.iso) +
                         (shot.is_metered ? " (metered: the average lands on middle grey)" : ""));
    const std::vector<std::string> effects = names_of(settings.effects);
    if (!effects.empty()) {
        std::string names;
        for (const std::string& name : effects) names += (names.empty() ? "" : ", ") + name;
        const auto light = settings.spectral_light();
        line("effects", names + (light ? ", illuminant " + light->text() : ""));
        if (any_is(settings.effects, &EffectInfo::needs_coatings)) line("coatings", coating_summary(lens));
    }
    if (verbose) {
        const double busy = stats.lens_seconds + stats.scene_seconds + stats.other_seconds;
        const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
        line("lens rays", million(count(stats.sampled_rays), stats.seconds) + "/s; " +
                              million(count(stats.sampled_rays), stats.lens_seconds) + "/s a core while in the lens, " +
                              percent(stats.lens_seconds, busy) + " of the time; " +
                              percent(count(stats.passed_rays), count(stats.sampled_rays)) +
                              " of the sampled rays pass");
        line("scene rays", million(count(stats.scene_rays), stats.seconds) + "/s; " +
                               million(count(stats.scene_rays), stats.scene_seconds) +
                               "/s a core while in the scene, " + percent(stats.scene_seconds, busy) + " of the time");
    }
    line("time", number_text(seconds, 3) + " s" +
                     (verbose ? ", of which " + number_text(stats.seconds, 3) + " s for the picture (set-up " +
                                    number_text(stats.setup_seconds, 2) + " s)"
                              : "") +
                     " on " + stats.device);
    if (!denoiser.empty()) line("denoised", "by " + denoiser);
    for (const std::string& path : pictures) line("picture", path);
    return text;
}

std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures) {
    const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
    std::string text = "frame " + std::to_string(frame) + ": " + number_text(data.effective_focal_length) + " mm, f/" +
                       number_text(data.f_number, 3) + ", focus " + distance_text(camera.lens.focus_distance / 1000) +
                       ", " + exposure_text(camera.exposure_time_s) + ", ISO " + number_text(camera.iso);
    for (const std::string& path : pictures) text += ", " + path;
    return text + '\n';
}

}  // namespace realcam::app
