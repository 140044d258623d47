#include "render_json.hpp"

#include <limits>

#include "../io/text/json_writer.hpp"
#include "../io/text/printable.hpp"
#include "../plan/plan.hpp"
#include "../render/settings/effect_names.hpp"
#include "../render/settings/setting_names.hpp"
#include "render_notices.hpp"

namespace realcam::app {
namespace {

using io::JsonWriter;

void write_texts(JsonWriter& json, const char* key, const std::vector<std::string>& texts) {
    json.key(key).begin_array();
    for (const std::string& text : texts) json.text(text);
    json.end();
}

void write_point(JsonWriter& json, const char* key, Vec3d p) {
    json.key(key).begin_array().number(p.x).number(p.y).number(p.z).end();
}

void write_lens(JsonWriter& json, const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    json.key("lens").begin_object();
    json.key("name").text(lens.name).key("title").text(lens.title);
    json.key("focal_length_mm").number(data.effective_focal_length).key("f_number").number(data.f_number);
    json.key("focus_distance_m").number(lens.focus_distance / 1000);
    json.end();
}

void write_camera(JsonWriter& json, const Camera& camera) {
    json.key("camera").begin_object();
    json.key("model").text(name_of(camera.model));
    write_point(json, "position_m", camera.pose.position_m);
    write_point(json, "look_at_m", camera.pose.look_at_m);
    write_point(json, "up", camera.pose.up);
    json.key("film_mm").begin_array().number(camera.film.width_mm).number(camera.film.height_mm).end();
    json.key("resolution").begin_array().number(camera.film.width).number(camera.film.height).end();
    json.end();
}

/// Writes the air; null if it is clear.
void write_air(JsonWriter& json, const Air& air) {
    json.key("air");
    if (!air.is_present()) {
        json.null();
        return;
    }
    const auto write_color = [&](const char* key, Color c) {
        write_point(json, key, {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)});
    };
    json.begin_object();
    write_color("extinction_per_m", air.extinction);
    write_color("albedo", air.albedo);
    json.key("anisotropy").number(static_cast<double>(air.anisotropy));
    json.end();
}

void write_exposure(JsonWriter& json, const shot::Shot& shot, const Image& image) {
    json.key("exposure").begin_object();
    json.key("exposure_time_s").number(shot.camera.exposure_time_s).key("iso").number(shot.camera.iso);
    json.key("is_metered").truth(shot.is_metered);
    json.key("stops_above_middle_grey").number(stops_above_grey(image, shot.camera.iso));
    json.end();
}

void write_settings(JsonWriter& json, const shot::ShotRequest& request, const View& view, const std::string& plan) {
    const RenderSettings& settings = request.settings;
    json.key("seed").number(settings.seed).key("max_bounces").number(settings.path().max_bounces);
    json.key("filter").text(name_among(kPixelFilters, settings.filter));
    json.key("transport").text(name_of(settings.transport)).key("clamp_cd_m2").number(settings.clamp);
    for (const auto& [name, value] : view.entries())
        json.key(name.substr(name.find(':') + 1)).text(io::printable(value));
    write_texts(json, "effects", names_of(settings.effects));
    const auto light = settings.spectral_light();
    json.key("illuminant").text(light ? light->text() : "").key("plan").text(plan);
}

/// Writes the noise goal; null if the number of samples was specified instead.
void write_noise(JsonWriter& json, const std::optional<NoiseGoal>& goal, const Image& image) {
    if (!goal) {
        json.key("noise").null();
        return;
    }
    json.key("noise").begin_object();
    json.key("goal").number(goal->noise).key("unit").text(goal->unit == NoiseUnit::codes ? "codes" : "share");
    json.key("is_reached").truth(image.shortfall.empty()).key("shortfall").text(image.shortfall);
    json.end();
}

void write_cost(JsonWriter& json, const RenderStats& stats, double seconds) {
    json.key("device").text(stats.device);
    json.key("time_s").begin_object();
    json.key("all").number(seconds).key("picture").number(stats.seconds).key("setup").number(stats.setup_seconds);
    json.end();
    json.key("rays").begin_object();
    json.key("sampled").number(static_cast<double>(stats.sampled_rays));
    json.key("passed").number(static_cast<double>(stats.passed_rays));
    json.key("scene").number(static_cast<double>(stats.scene_rays));
    json.end();
}

}  // namespace

std::string render_as_json(const shot::Shot& shot, const shot::ShotRequest& request, const View& view,
                           const Image& image, const std::vector<std::string>& pictures, const std::string& plan,
                           const std::string& denoiser, const std::vector<std::string>& warnings, double seconds) {
    JsonWriter json;
    json.begin_object();
    write_texts(json, "pictures", pictures);
    json.key("scene").text(request.scene).key("triangles").number(static_cast<double>(shot.scene.triangle_count()));
    json.key("has_daylight").truth(shot.has_daylight);
    write_air(json, shot.scene.static_geometry->air);
    write_lens(json, shot.camera.lens);
    write_camera(json, shot.camera);
    write_exposure(json, shot, image);
    json.key("spp").number(static_cast<double>(image.spp));
    write_noise(json, request.settings.noise, image);
    json.key("denoiser").text(denoiser);
    write_settings(json, request, view, plan);
    write_cost(json, image.stats, seconds);
    write_texts(json, "warnings", warnings);
    return json.end().finish() + '\n';
}

std::string json_of(const Plan& plan) {
    io::JsonWriter json;
    json.begin_object().key("model").text(name_of(plan.model)).key("effects").begin_array();
    for (const std::string& name : names_of(plan.effects)) json.text(name);
    json.end().key("decisions").begin_array();
    for (const PlanDecision& decision : plan.decisions) {
        json.begin_object()
            .key("effect")
            .text(decision.name)
            .key("size")
            .number(decision.size)
            .key("threshold")
            .number(decision.threshold)
            .key("unit")
            .text(name_of(decision.unit))
            .key("decision")
            .text(decision.is_kept ? "kept" : "left out")
            .key("by")
            .text(decision.by == DecidedBy::user ? "user" : "planner")
            .key("time_share")
            .number(decision.time.value_or(std::numeric_limits<double>::quiet_NaN()))
            .key("reason")
            .text(decision.reason)
            .end();
    }
    return json.end().end().finish() + '\n';
}

}  // namespace realcam::app
