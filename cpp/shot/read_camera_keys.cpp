#include "read_camera_keys.hpp"

#include "shake_curve.hpp"

namespace realcam::shot {
namespace {

std::optional<CameraKeyInterpolation> interpolation_named(std::string_view name) {
    if (name == "linear") return CameraKeyInterpolation::linear;
    if (name == "smooth") return CameraKeyInterpolation::smooth;
    if (name == "step") return CameraKeyInterpolation::step;
    return std::nullopt;
}

/// Top-level key of the file that a value in [[key]] replaces; a file with both is an error.
struct ReplacedKey {
    bool (*has)(const CameraKey& key);  ///< true if the keyframe has the value
    const char* key;    ///< name in [[key]]
    const char* top_level_key;  ///< name outside of [[key]]
    /// True for a setting of the lens, not of the camera. The top-level value then applies only to the file's first
    /// lens.
    bool is_lens_setting = false;
};

template <auto value>
bool has(const CameraKey& key) {
    return (key.*value).has_value();
}

constexpr ReplacedKey kReplacedKeys[] = {
    {has<&CameraKey::focus_m>, "focus_m", "focus_m", true},
    {has<&CameraKey::focal_length_mm>, "focal_length_mm", "focal_length_mm", true},
    {has<&CameraKey::focal_length_mm>, "focal_length_mm", "zoom", true},
    {has<&CameraKey::f_number>, "f_number", "f_number", true},
    {has<&CameraKey::blades>, "blades", "blades", true},
    {has<&CameraKey::blade_rounding>, "blade_rounding", "blade_rounding", true},
    {has<&CameraKey::blade_rotation_deg>, "blade_rotation_deg", "blade_rotation_deg", true},
    {has<&CameraKey::exposure_time_s>, "exposure_time_s", "exposure_time_s"},
    {has<&CameraKey::iso>, "iso", "iso"},
    {has<&CameraKey::iso>, "iso", "iso_follows_s"},
    {has<&CameraKey::film_right_mm>, "film_shift_mm", "film_shift_mm"}};

/// Reads the keyframes [[key]].
void read_keys(const ShotTable& shot, ShotRequest& request) {
    bool has_other_lens = shot.is_changed("lens");  // a changed lens replaces those of the keys
    for (const ShotTable& table : shot.tables("key")) {
        table.allow({"time_s", "lens", "focus_m", "focal_length_mm", "f_number", "blades", "blade_rounding",
                     "blade_rotation_deg", "exposure_time_s", "iso", "film_shift_mm", "interpolation"});
        CameraKey key{.time_s = table.required_number("time_s")};
        if (table.find("focus_m")) {
            key.focus_m = table.number_or_auto("focus_m", "a number of metres or inf");
            if (!key.focus_m)
                table.fail("\"focus_m\" of a key must be a number of metres or inf", table.find("focus_m"));
        }
        key.focal_length_mm = table.number("focal_length_mm");
        key.f_number = table.number("f_number");
        key.exposure_time_s = table.number("exposure_time_s");
        key.iso = table.number("iso");
        if (const auto blades = table.number("blades")) key.blades = table.whole("blades", *blades);
        key.blade_rounding = table.number("blade_rounding");
        key.blade_rotation_deg = table.number("blade_rotation_deg");
        if (const auto shift = table.numbers("film_shift_mm", 2); !shift.empty()) {
            key.film_right_mm = shift[0];
            key.film_up_mm = shift[1];
        }
        key.interpolation =
            table.named("interpolation", interpolation_named, "linear, smooth or step").value_or(key.interpolation);
        if (const std::string lens = lens_of(table); !lens.empty()) key.lens.emplace().name = lens;
        table.checked("time_s", [&] { validate(key); });
        const double* const last = request.keys.empty() ? nullptr : &request.keys.back().time_s;
        if (const std::string why = key_time_error(key.time_s, last); !why.empty())
            table.fail(why, table.find("time_s"));
        has_other_lens = has_other_lens || key.lens;
        for (const ReplacedKey& replaced : kReplacedKeys)
            if (const toml::node* node = replaced.has(key) && !(replaced.is_lens_setting && has_other_lens)
                                             ? shot.find(replaced.top_level_key)
                                             : nullptr)
                shot.fail('"' + std::string(replaced.top_level_key) + "\" and \"" + replaced.key +
                              "\" of [[key]] exclude each other",
                          node);
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
