#include "image_metadata.hpp"

#include <cstdio>
#include <initializer_list>
#include <numbers>

#include "../../optics/coating/coated_surface.hpp"
#include "../../optics/lens/focus.hpp"
#include "../../render/settings/effect_names.hpp"
#include "../../render/settings/setting_names.hpp"

namespace realcam::io {
namespace {

/// Formats a number with nine significant digits.
std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

/// Formats numbers, separated by blanks, with 15 significant digits, which positions far from the scene's origin need.
std::string numbers(std::initializer_list<double> values) {
    std::string list;
    for (const double value : values) {
        char text[32];
        std::snprintf(text, sizeof text, "%.15g", value + 0.0);  // no -0
        list += (list.empty() ? "" : " ") + std::string(text);
    }
    return list;
}

}  // namespace

ImageMetadata metadata_of(const Camera& camera, const RenderSettings& settings) {
    const FirstOrder data = nominal_first_order(camera.lens);
    ImageMetadata metadata;
    metadata.lens = camera.lens.name;
    metadata.model = name_of(camera.model);
    metadata.focal_length_mm = data.effective_focal_length;
    metadata.f_number = f_number_at_infinity(centred(camera.lens));
    metadata.iris = camera.lens.iris;
    metadata.focus_distance_m = camera.lens.focus_distance / 1000;
    metadata.film_width_mm = camera.film.width_mm;
    metadata.film_height_mm = camera.film.height_mm;
    metadata.film_shift_mm = camera.film.shift_mm;
    metadata.pixel_width_um = 1000 * camera.film.width_mm / camera.film.width;
    metadata.pixel_height_um = 1000 * camera.film.height_mm / camera.film.height;
    metadata.pinhole = pinhole_camera(camera, pose_at_mid_exposure(camera));
    metadata.exposure_time_s = camera.exposure_time_s;
    metadata.shutter_opens_s = camera.shutter.opens_s;
    metadata.readout_time_s = camera.shutter.readout_time_s;
    metadata.iso = camera.iso;
    metadata.seed = settings.seed;
    metadata.spp = settings.spp;
    metadata.filter = settings.filter;
    metadata.transport = settings.transport;
    metadata.clamp_cd_m2 = settings.clamp;
    for (const std::string& name : names_of(settings.effects))
        metadata.effects += (metadata.effects.empty() ? "" : ",") + name;
    if (const auto light = settings.spectral_light()) metadata.illuminant = light->text();
    if (settings.lens_filter) metadata.lens_filter = settings.lens_filter->text();
    if (any_active_has(settings.effects, &EffectInfo::needs_coatings)) metadata.coatings = coating_summary(camera.lens);
    return metadata;
}

std::vector<std::pair<std::string, std::string>> ImageMetadata::entries() const {
    std::vector<std::pair<std::string, std::string>> entries = {
        {"realcam:version", REALCAM_VERSION},
        {"realcam:lens", lens},
        {"realcam:model", model},
        {"realcam:focal_length_mm", number(focal_length_mm)},
        {"realcam:f_number", number(f_number)},
        {"realcam:focus_distance_m", number(focus_distance_m)},
        {"realcam:film_mm", number(film_width_mm) + "x" + number(film_height_mm)},
        {"realcam:pixel_pitch_um", number(pixel_width_um) + "x" + number(pixel_height_um)},
        {"realcam:exposure_time_s", number(exposure_time_s)},
        {"realcam:iso", number(iso)},
        {"realcam:seed", std::to_string(seed)},
        {"realcam:spp", std::to_string(spp)}};
    if (pinhole) {
        const PinholeCamera& p = *pinhole;
        entries.emplace_back("realcam:camera_matrix",
                             numbers({p.focal_x, 0, p.centre_x, 0, p.focal_y, p.centre_y, 0, 0, 1}));
        const Vec3d t = p.translation_m;
        entries.emplace_back("realcam:world_to_camera",
                             numbers({p.right.x, p.right.y, p.right.z, t.x, p.down.x, p.down.y, p.down.z, t.y,
                                      p.forward.x, p.forward.y, p.forward.z, t.z}));
    }
    // Defaults are not written: the box filter, full light transport, a centred film, a round diaphragm, and a global
    // shutter that opens at time 0.
    if (film_shift_mm.x != 0 || film_shift_mm.y != 0)
        entries.emplace_back("realcam:film_shift_mm", numbers({film_shift_mm.x, film_shift_mm.y}));
    if (iris.blades > 0) {
        entries.emplace_back("realcam:blades", std::to_string(iris.blades));
        entries.emplace_back("realcam:blade_rounding", number(iris.rounding));
        entries.emplace_back("realcam:blade_rotation_deg", number(iris.rotation_rad * 180 / std::numbers::pi));
    }
    if (filter != PixelFilter::box) entries.emplace_back("realcam:filter", name_among(kPixelFilters, filter));
    if (transport != LightTransport::paths) entries.emplace_back("realcam:transport", name_of(transport));
    if (shutter_opens_s != 0) entries.emplace_back("realcam:shutter_opens_s", number(shutter_opens_s));
    if (readout_time_s > 0) entries.emplace_back("realcam:readout_time_s", number(readout_time_s));
    if (clamp_cd_m2 > 0) entries.emplace_back("realcam:clamp_cd_m2", number(clamp_cd_m2));
    if (!effects.empty()) entries.emplace_back("realcam:effects", effects);
    if (!illuminant.empty()) entries.emplace_back("realcam:illuminant", illuminant);
    if (!lens_filter.empty()) entries.emplace_back("realcam:lens_filter", lens_filter);
    if (!coatings.empty()) entries.emplace_back("realcam:coatings", coatings);
    if (!plan.empty()) entries.emplace_back("realcam:plan", plan);
    if (!film.empty()) entries.emplace_back("realcam:film", film);
    if (!denoiser.empty()) entries.emplace_back("realcam:denoiser", denoiser);
    return entries;
}

}  // namespace realcam::io
