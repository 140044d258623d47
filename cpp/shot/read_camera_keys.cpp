#include "read_camera_keys.hpp"

#include <ranges>

#include "shake_curve.hpp"
#include "shot_keys.hpp"

namespace realcam::shot {
namespace {

std::optional<CameraKeyInterpolation> interpolation_named(std::string_view name) {
    if (name == "linear") return CameraKeyInterpolation::linear;
    if (name == "smooth") return CameraKeyInterpolation::smooth;
    if (name == "step") return CameraKeyInterpolation::step;
    return std::nullopt;
}

/// Throws InputError if the file has outside of [[key]] a value that a setting in [[key]] replaces.
void check_not_outside(const ShotTable& shot, const ShotKey& setting) {
    std::vector<std::string_view> replaced = setting.replaces;
    replaced.insert(replaced.begin(), setting.name);
    for (const std::string_view name : replaced)
        if (const toml::node* const node = shot.find(name))
            shot.fail('"' + std::string(name) + "\" and \"" + setting.name + "\" of [[key]] exclude each other", node);
}

/// Reads the keyframes [[key]].
void read_keys(const ShotTable& shot, ShotRequest& request) {
    auto settings = std::views::filter(shot_keys(), [](const ShotKey& key) { return key.read_keyframe != nullptr; });
    bool has_other_lens = shot.is_changed("lens");  // a changed lens replaces those of the keys
    for (const ShotTable& table : shot.tables("key")) {
        std::vector<std::string_view> names = {"time_s", "lens", "interpolation"};
        for (const ShotKey& setting : settings) names.emplace_back(setting.name);
        table.allow(names);
        CameraKey key{.time_s = table.required_number("time_s")};
        for (const ShotKey& setting : settings)
            if (table.find(setting.name)) setting.read_keyframe(table, setting, key);
        key.interpolation =
            table.named("interpolation", interpolation_named, "linear, smooth or step").value_or(key.interpolation);
        if (const std::string lens = lens_of(table); !lens.empty()) key.lens.emplace().name = lens;
        table.checked("time_s", [&] { validate(key); });
        const double* const last = request.keys.empty() ? nullptr : &request.keys.back().time_s;
        if (const std::string why = key_time_error(key.time_s, last); !why.empty())
            table.fail(why, table.find("time_s"));
        has_other_lens = has_other_lens || key.lens;
        for (const ShotKey& setting : settings)
            if (table.find(setting.name) && !(setting.is_lens_setting && has_other_lens))
                check_not_outside(shot, setting);
        request.keys.push_back(key);
        request.key_locations.push_back(table.location());
    }
}

/// Reads the table [shake].
void read_shake(const ShotTable& shot, Shake& shake) {
    const toml::node* node = shot.find("shake");
    if (!node) return;
    if (!node->is_table()) shot.fail("expected a table [shake]", node);
    const ShotTable table(*node->as_table(), shot.file());
    table.allow({"file", "rms_deg", "rms_mm", "corner_hz", "seed"});
    if (const std::string file = table.path("file"); !file.empty()) shake.curve = read_shake_curve(file);
    shake.rms_deg = table.number("rms_deg").value_or(0);
    shake.rms_mm = table.number("rms_mm").value_or(0);
    shake.corner_hz = table.number("corner_hz").value_or(shake.corner_hz);
    if (const auto seed = table.number("seed")) shake.seed = table.whole<std::uint32_t>("seed", *seed);
    for (const char* key : {"rms_deg", "rms_mm", "corner_hz"})
        if (table.find(key)) table.checked(key, [&] { validate(shake); });
    if (shake.is_still()) table.fail("[shake] needs a \"file\", \"rms_deg\" or \"rms_mm\"");
}

}  // namespace

std::string lens_of(const ShotTable& table) {
    const std::string path = table.path("lens"), name = table.name("lens");
    return io::is_lens_path(name, path) ? path : name;
}

void read_camera_keys(const ShotTable& shot, ShotRequest& request) {
    read_keys(shot, request);
    read_shake(shot, request.shake);
}

}  // namespace realcam::shot
