#include "shot_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/text/printable.hpp"
#include "../io/text/toml_document.hpp"
#include "../render/effect_names.hpp"
#include "names.hpp"
#include "read_camera_keys.hpp"
#include "read_scene_request.hpp"

namespace realcam::shot {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
/// A shot file is some lines; what is larger is something else.
constexpr std::uintmax_t kMostBytes = 1 << 20;

/// The keys of a shot file, read into a request.
class ShotReader {
public:
    ShotReader(const toml::table& table, const std::string& path) : table_(table, path) {}

    ShotRequest read() const {
        table_.allow({"format",
                      "scene",
                      "scale",
                      "texture",
                      "environment",
                      "environment_cd_m2",
                      "environment_layer",
                      "environment_scale",
                      "environment_rotation_deg",
                      "lens",
                      "zoom",
                      "f_number",
                      "blades",
                      "blade_rounding",
                      "blade_rotation_deg",
                      "film_mm",
                      "film_shift_mm",
                      "resolution",
                      "camera",
                      "position_m",
                      "look_at_m",
                      "up",
                      "focus_m",
                      "model",
                      "exposure_time_s",
                      "iso",
                      "spp",
                      "noise",
                      "noise_codes",
                      "seconds",
                      "max_spp",
                      "seed",
                      "max_bounces",
                      "tone",
                      "layers",
                      "effects",
                      "illuminant",
                      "object",
                      "material",
                      "light",
                      "transport",
                      "clamp_cd_m2",
                      "shutter_opens_s",
                      "readout_time_s",
                      "pose",
                      "focal_length_mm",
                      "key",
                      "shake",
                      "iso_follows_s"});
        if (table_.number("format") != kFormat) table_.fail("format = " + std::to_string(kFormat) + " is wanted");
        ShotRequest shot;
        shot.scene = table_.path("scene");
        if (shot.scene.empty()) table_.fail("scene is missing: the file to photograph");
        shot.scale = table_.number("scale").value_or(shot.scale);
        if (!(shot.scale > 0)) table_.fail("\"scale\" must be a positive number of metres", table_.find("scale"));
        read_light(shot);
        shot.additions = read_scene_request(table_);
        read_camera(shot);
        read_samples(shot);
        read_settings(shot.settings);
        return shot;
    }

private:
    void read_light(ShotRequest& shot) const {
        shot.texture = table_.path("texture");
        shot.environment_file = table_.path("environment");
        shot.environment_layer = table_.text("environment_layer");
        if (!shot.environment_layer.empty() && shot.environment_file.empty())
            table_.fail("\"environment_layer\" chooses a layer of \"environment\", and there is none",
                        table_.find("environment_layer"));
        read_environment_change(shot);
        const std::optional<Vec3d> constant = table_.number_or_three("environment_cd_m2");
        if (!constant) return;
        if (!shot.environment_file.empty())
            table_.fail("environment and environment_cd_m2 exclude each other", table_.find("environment_cd_m2"));
        shot.environment_cd_m2 = static_cast<Vec3f>(*constant);
        table_.checked("environment_cd_m2", [&] { check_environment(*shot.environment_cd_m2); });
    }

    void read_environment_change(ShotRequest& shot) const {
        shot.environment_change = {table_.number("environment_scale").value_or(1),
                                   table_.number("environment_rotation_deg").value_or(0)};
        const char* key = table_.find("environment_scale") ? "environment_scale" : "environment_rotation_deg";
        const toml::node* node = table_.find(key);
        if (node && !table_.find("environment") && !table_.find("environment_cd_m2"))
            table_.fail('"' + std::string(key) + "\" changes an environment, and there is none", node);
        table_.checked(key, [&] { realcam::check_environment_change(shot.environment_change); });
    }

    void read_camera(ShotRequest& shot) const {
        if (const std::string lens = lens_of(table_); !lens.empty()) shot.lens = lens;
        shot.zoom = table_.text("zoom");
        if (shot.zoom.empty() && table_.find("zoom"))
            table_.fail("\"zoom\" is empty; the name of a zoom position of the lens is wanted", table_.find("zoom"));
        shot.focal_length_mm = table_.number("focal_length_mm");
        if (shot.focal_length_mm && !shot.zoom.empty())
            table_.fail("\"zoom\" and \"focal_length_mm\" exclude each other", table_.find("focal_length_mm"));
        shot.f_number = table_.number("f_number");
        if (const auto blades = table_.number("blades")) shot.blades = table_.whole("blades", *blades);
        shot.blade_rounding = table_.number("blade_rounding");
        shot.blade_rotation_deg = table_.number("blade_rotation_deg");
        table_.checked(shot.blades ? "blades" : "blade_rounding", [&] { check_blades(shot); });
        if (const auto size = table_.numbers("film_mm", 2); !size.empty()) shot.film_mm = {size[0], size[1]};
        if (const auto shift = table_.numbers("film_shift_mm", 2); !shift.empty())
            shot.film_shift_mm = {shift[0], shift[1]};
        if (const auto pixels = table_.numbers("resolution", 2); !pixels.empty())
            shot.resolution = {table_.whole("resolution", pixels[0]), table_.whole("resolution", pixels[1])};
        shot.view.position_m = table_.point("position_m");
        shot.view.look_at_m = table_.point("look_at_m");
        shot.view.camera = table_.name("camera");
        if (const toml::node* node = table_.find("camera")) {
            if (shot.view.camera.empty())
                table_.fail("\"camera\" is empty; the name of a camera of the scene, or \"none\", is wanted", node);
            for (const char* other : {"position_m", "look_at_m", "pose"})
                if (table_.find(other))
                    table_.fail('"' + std::string(other) + "\" and \"camera\" exclude each other", node);
        }
        shot.view.up = table_.point("up").value_or(shot.view.up);
        shot.view.focus_distance_m = table_.number_or_auto("focus_m", "a number of metres, inf or \"auto\"");
        shot.model = table_.named("model", model_named, kModelNames).value_or(shot.model);
        shot.exposure_time_s = table_.number_or_auto("exposure_time_s", "a number of seconds or \"auto\"");
        shot.iso = table_.number("iso").value_or(shot.iso);
        shot.shutter.opens_s = table_.number("shutter_opens_s").value_or(0);
        shot.shutter.readout_time_s = table_.number("readout_time_s").value_or(0);
        read_motion(shot);
        read_camera_keys(table_, shot);
        shot.tone = table_.named("tone", tone_named, kToneNames).value_or(shot.tone);
    }

    void read_motion(ShotRequest& shot) const {
        for (const ShotTable& key : table_.tables("pose")) {
            key.allow({"time_s", "position_m", "look_at_m", "up"});
            shot.motion.push_back({key.number_wanted("time_s"),
                                   {key.point_wanted("position_m"), key.point_wanted("look_at_m"),
                                    key.point("up").value_or(shot.view.up)}});
        }
        if (shot.motion.empty()) return;
        for (const char* other : {"position_m", "look_at_m"})
            if (const toml::node* node = table_.find(other))
                table_.fail('"' + std::string(other) + "\" and [[pose]] exclude each other", node);
        table_.checked("pose", [&] { validate(shot.motion); });
    }

    void read_samples(ShotRequest& shot) const {
        if (table_.find("spp")) {
            const auto spp = table_.number_or_auto("spp", "a whole number or \"auto\"");
            shot.sampling = spp ? Sampling::counted : Sampling::by_noise;
            if (spp) shot.settings.spp = table_.whole("spp", *spp);
        }
        const auto read = [&](const char* key, auto& value, const auto& found) {
            value = found;
            table_.checked(key, [&] { goal_of(shot.noise); });
        };
        read("noise", shot.noise.noise, table_.number("noise"));
        read("noise_codes", shot.noise.noise_codes, table_.number("noise_codes"));
        read("seconds", shot.noise.seconds, table_.number("seconds"));
        if (const auto most = table_.number("max_spp"))
            read("max_spp", shot.noise.max_spp, table_.whole("max_spp", *most));
        table_.checked("spp", [&] { settle_noise_goal(shot); });
    }

    void read_settings(RenderSettings& settings) const {
        const auto read = [&](const char* key, auto& value) {
            using Value = std::remove_reference_t<decltype(value)>;
            if (const auto number = table_.number(key)) value = table_.whole<Value>(key, *number);
        };
        read("seed", settings.seed);
        if (const auto bounces = table_.number_or_auto("max_bounces", "a whole number or \"auto\""))
            settings.max_bounces = table_.whole("max_bounces", *bounces);
        settings.transport = table_.named("transport", transport_named, kTransportNames).value_or(settings.transport);
        settings.clamp = table_.number("clamp_cd_m2").value_or(0);
        if (table_.find("effects")) {
            const std::vector<std::string> effects = table_.texts("effects");
            table_.checked("effects", [&] { settings.effects = effects_named(effects); });
        }
        table_.checked("illuminant", [&] { settings.illuminant = read_illuminant(); });
        if (const std::string why = illuminant_error(settings); !why.empty())
            table_.fail(why, table_.find("illuminant"));
        table_.checked(settings.clamp >= 0 ? "spp" : "clamp_cd_m2", [&] { validate(settings); });
        const std::vector<std::string> layers = table_.texts("layers");
        table_.checked("layers", [&] { settings.layers = layers_named(layers); });
    }

    /// A name, a wavelength, or [wavelength, power] of each point of a table.
    std::optional<Illuminant> read_illuminant() const {
        const toml::node* node = table_.find("illuminant");
        if (!node) return std::nullopt;
        if (node->is_string()) return Illuminant::parse(table_.text("illuminant"));
        if (node->is_number()) return Illuminant::line(*table_.number("illuminant"));
        std::vector<SpectrumPoint> points;
        if (const toml::array* pairs = node->as_array()) {
            for (const toml::node& item : *pairs) {
                const toml::array* pair = item.as_array();
                if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number()) {
                    points.clear();
                    break;
                }
                points.push_back({(*pair)[0].value_or(0.0), (*pair)[1].value_or(0.0)});
            }
        }
        if (points.empty())
            throw InputError(std::string("illuminant: ") + Illuminant::kWanted +
                             " is wanted; in a shot file a table is [[400, 0.5], [550, 1], [700, 0.2]]");
        return Illuminant::table(std::move(points));
    }

    ShotTable table_;
};

/// Keys of a shot that say the same thing in two ways, so that one takes the place of the others.
struct Replaced {
    std::string_view key;
    std::vector<std::string_view> gone;
};
const Replaced kReplaced[] = {
    {"lens", {"zoom", "focal_length_mm"}},
    {"zoom", {"focal_length_mm"}},
    {"focal_length_mm", {"zoom"}},
    {"environment", {"environment_cd_m2", "environment_layer"}},
    {"environment_cd_m2", {"environment", "environment_layer"}},
    {"camera", {"position_m", "look_at_m", "pose"}},
    {"position_m", {"camera", "pose"}},
    {"look_at_m", {"camera", "pose"}},
    {"pose", {"camera", "position_m", "look_at_m"}},
    {"spp", {"noise", "noise_codes", "seconds", "max_spp"}},
    {"noise", {"noise_codes", "spp"}},
    {"noise_codes", {"noise", "spp"}},
    {"iso", {"iso_follows_s"}},
};

/// The changes have no lines in messages: toml++ copies a node without its source.
void change(toml::table& shot, const toml::table& changes) {
    const auto forget = [&](std::string_view key) {
        shot.erase(key);
        if (toml::array* const keys = shot["key"].as_array())
            for (toml::node& of_time : *keys)
                if (toml::table* const table = of_time.as_table()) table->erase(key);
    };
    for (const auto& [key, value] : changes) {
        forget(key.str());
        for (const Replaced& replaced : kReplaced)
            if (replaced.key == key.str())
                for (const std::string_view other : replaced.gone)
                    if (!changes.contains(other)) forget(other);
    }
    if (toml::array* const keys = shot["key"].as_array(); keys && !changes.contains("key")) {
        const auto says_nothing = [](const toml::node& key) {
            const toml::table* const table = key.as_table();
            return table && std::ranges::all_of(*table, [](const auto& entry) {
                       return entry.first == "time_s" || entry.first == "interpolation";
                   });
        };
        for (auto key = keys->begin(); key != keys->end();)
            key = says_nothing(*key) ? keys->erase(key) : std::next(key);
        if (keys->empty()) shot.erase("key");
    }
    for (const auto& [key, value] : changes) shot.insert_or_assign(key, value);
}

}  // namespace

void check_environment_change(const ShotRequest& request) {
    realcam::check_environment_change(request.environment_change);
    if (!request.environment_layer.empty() && request.environment_file.empty())
        throw InputError("the environment's layer is one of an environment's file, and none was asked for");
    if (!request.environment_change.says_nothing() && !request.chooses_environment())
        throw InputError("environment scale and rotation change an environment, and none was asked for");
}

void check_environment(Vec3f v) {
    constexpr float kBrightest = 1e20f;  // as scene_checks.hpp has it
    const auto good = [](float c) { return c >= 0 && c <= kBrightest; };
    if (!good(v.x) || !good(v.y) || !good(v.z))
        throw InputError("an environment's radiance must lie between 0 and 1e20 cd/m^2");
}

bool is_shot_file(const std::string& path) {
    return fs::path(path).extension() == ".toml";
}

ShotRequest parse_shot(std::string_view text, const std::string& path, std::string_view changes) {
    toml::table table = io::parse_toml(text, path, ShotTable::fail_at);
    if (!changes.empty()) change(table, io::parse_toml(changes, path, ShotTable::fail_at));
    return ShotReader(table, path).read();
}

ShotRequest shot_of_scene(const std::string& path, std::string_view changes) {
    ShotRequest request = parse_shot("format = 1\nscene = \"scene\"\n", path, changes);
    request.scene = path;
    return request;
}

ShotRequest read_shot(const std::string& path, std::string_view changes) {
    if (!is_shot_file(path) && !fs::is_directory(path)) return shot_of_scene(path, changes);
    const std::string why = io::why_unreadable(path);
    if (!why.empty()) throw InputError(path + ": " + why);
    if (fs::file_size(path) > kMostBytes) throw InputError(path + ": is too large for a shot file");
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_shot(text, path, changes);
}

}  // namespace realcam::shot
