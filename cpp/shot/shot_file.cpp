#include "shot_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/stage_reader.hpp"
#include "../io/text/printable.hpp"
#include "../io/text/text_number.hpp"
#include "../io/text/toml_document.hpp"
#include "read_camera_keys.hpp"
#include "read_scene_request.hpp"

namespace realcam::shot {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
/// Largest size of a shot file, which has some lines; a larger file is of another kind.
constexpr std::uintmax_t kMaxBytes = 1 << 20;

/// Keys that are not in shot_keys(): tables, and values that are read together with others.
constexpr std::string_view kTables[] = {"format", "scene", "object", "material", "light", "pose", "key", "shake"};

toml::array array_of(const std::vector<double>& values) {
    toml::array array;
    for (const double value : values) array.push_back(value);
    return array;
}

/// Parses an option's text by its syntax, and passes the value to `store`, unless the text is itself the value. Returns
/// false if the text is invalid.
template <class Store>
bool parse_option_text(Syntax syntax, const std::string& word, const Store& store) {
    const auto store_numbers = [&](char separator, std::size_t count) {
        const auto values = io::numbers_in(word, separator, count);
        if (values) store(array_of(*values));
        return values.has_value();
    };
    const auto store_number = [&](bool may_be_infinite) {
        const auto value = io::number_in(word);
        const auto fraction = value ? std::nullopt : io::numbers_in(word, '/', 2);
        if (fraction && (*fraction)[1] != 0) return store((*fraction)[0] / (*fraction)[1]), true;
        if (!value || (std::isinf(*value) && !may_be_infinite)) return false;
        return store(*value), true;
    };
    const auto store_whole = [&] {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) return false;
        return store(value), true;
    };
    switch (syntax) {
        case Syntax::text:
        case Syntax::spectrum: return true;
        case Syntax::number: return store_number(false);
        case Syntax::number_or_auto: return word == "auto" || store_number(false);
        case Syntax::distance_or_auto: return word == "auto" || store_number(true);
        case Syntax::whole: return store_whole();
        case Syntax::whole_or_auto: return word == "auto" || store_whole();
        case Syntax::number_or_file: return store_number(true) || true;
        case Syntax::three_numbers: return store_numbers(',', 3);
        case Syntax::two_numbers: return store_numbers(',', 2);
        case Syntax::size: return store_numbers('x', 2);
        case Syntax::names: {
            toml::array names;
            std::istringstream list(word);
            for (std::string name; std::getline(list >> std::ws, name, ',');) names.push_back(name);
            store(names);
            return true;
        }
    }
    return false;
}

/// Replaces values of a table that are texts, as on the command line, by their parsed values. `shot`: the same table,
/// for messages. Throws InputError.
void parse_option_texts(toml::table& table, const ShotTable& shot) {
    for (const ShotKey& key : shot_keys()) {
        const toml::node* const node = table.get(key.name);
        if (!node || !node->is_string()) continue;
        const std::string word = *node->value<std::string>();
        const auto store = [&](const auto& value) { table.insert_or_assign(key.name, value); };
        if (!parse_option_text(key.syntax, word, store))
            shot.fail(shot.shown(key.name) + " must be " + key.wanted + "; it is " + io::in_quotes(word), node);
    }
}

/// Reads the keys of a shot file into a request.
class ShotReader {
public:
    ShotReader(const toml::table& table, const std::string& path, const Changes& changes)
        : table_(table, path, &changes) {}

    ShotRequest read() const {
        if (table_.number("format") != kFormat) table_.fail("expected format = " + std::to_string(kFormat));
        ShotRequest shot;
        shot.scene = table_.path("scene");
        if (shot.scene.empty()) table_.fail("scene is missing: the file to photograph");
        for (const ShotKey& key : shot_keys())
            if (table_.find(key.name)) key.read(table_, key, shot);
        shot.additions = read_scene_request(table_);
        read_motion(shot);
        read_camera_keys(table_, shot);
        check(shot);
        return shot;
    }

private:
    /// Reads the tables [[pose]], the motion of the camera.
    void read_motion(ShotRequest& shot) const {
        for (const ShotTable& key : table_.tables("pose")) {
            key.allow({"time_s", "position_m", "look_at_m", "up"});
            shot.motion.push_back({key.required_number("time_s"),
                                   {key.required_point("position_m"), key.required_point("look_at_m"),
                                    key.point("up").value_or(shot.view.up)}});
        }
        table_.checked("pose", [&] {
            if (!shot.motion.empty()) validate(shot.motion);
        });
    }

    /// Sets the noise goal, and throws InputError if values are invalid or contradict each other.
    void check(ShotRequest& shot) const {
        exclude("environment", {"environment_cd_m2"});
        exclude("zoom", {"focal_length_mm"});
        for (const char* const key : {"calibration_camera", "vignetting"})
            if (table_.find(key) && shot.calibration.file.empty())
                table_.fail(table_.shown(key) + " belongs to a calibration, and there is none", table_.find(key));
        exclude("camera", {"position_m", "look_at_m", "pose"});
        exclude("pose", {"position_m", "look_at_m"});
        if (!(shot.scale > 0))
            table_.fail(table_.shown("scale") + " must be a positive number of metres", table_.find("scale"));
        if (table_.find("environment_layer") && shot.environment_file.empty())
            table_.fail(table_.shown("environment_layer") + " chooses a layer of \"environment\", and there is none",
                        table_.find("environment_layer"));
        if (shot.environment_cd_m2)
            table_.checked(table_.find("environment") ? "environment" : "environment_cd_m2",
                           [&] { check_environment(*shot.environment_cd_m2); });
        for (const char* key : {"environment_scale", "environment_rotation_deg"}) {
            const toml::node* const node = table_.find(key);
            if (node && !shot.chooses_environment())
                table_.fail(table_.shown(key) + " changes an environment, and there is none", node);
            if (node) table_.checked(key, [&] { check_environment_change(shot.environment_change); });
        }
        table_.checked(shot.blades ? "blades" : "blade_rounding", [&] { check_blades(shot); });
        table_.checked("spp", [&] { resolve_noise_goal(shot); });
        if (const std::string why = spectrum_error(shot.settings); !why.empty())
            table_.fail(why, table_.find(shot.settings.illuminant ? "illuminant" : "lens_filter"));
        table_.checked(shot.settings.clamp >= 0 ? "spp" : "clamp_cd_m2", [&] { validate(shot.settings); });
    }

    /// Throws InputError if the table has `key` and one of `others`.
    void exclude(const char* key, std::initializer_list<const char*> others) const {
        for (const char* const other : others)
            if (const toml::node* const node = table_.find(key) ? table_.find(other) : nullptr)
                table_.fail(table_.shown(other) + " and " + table_.shown(key) + " exclude each other", node);
    }

    ShotTable table_;
};

/// Throws InputError for a key that shot files do not have.
void reject_unknown_keys(const ShotTable& table) {
    std::vector<std::string_view> names(std::begin(kTables), std::end(kTables));
    for (const ShotKey& key : shot_keys()) names.emplace_back(key.name);
    table.allow(names);
}

/// Keys whose values a change of this key removes.
std::vector<std::string_view> replaced_by(std::string_view name) {
    if (name == "pose") return {"camera", "position_m", "look_at_m"};
    for (const ShotKey& key : shot_keys())
        if (key.name == name) return key.replaces;
    return {};
}

/// Name of a key in messages about the command line: its option, or else the key in quotes.
std::string option_of(std::string_view name) {
    for (const ShotKey& key : shot_keys())
        if (key.name == name && key.option) return key.option;
    return '"' + std::string(name) + '"';
}

/// Sets the visibility in the table [air] of a shot; its keys other than the extinction remain. `value`: a number, or
/// its text on the command line. Returns false if `value` is something else, or if the shot has no such table.
bool change_visibility(toml::table& shot, const toml::node& value) {
    toml::table* const air = shot["air"].as_table();
    if (!air) return false;
    const auto set = [&](const auto& visibility_m) {
        air->erase("extinction_per_m");
        air->insert_or_assign("visibility_m", visibility_m);
    };
    if (const auto word = value.value<std::string>()) return parse_option_text(Syntax::number, *word, set);
    if (value.is_number()) set(*value.value<double>());
    return value.is_number();
}

/// Applies changes to a shot file's table. Changed values have no lines in messages: toml++ copies a node without its
/// source.
void apply_changes(toml::table& shot, const toml::table& changes) {
    const auto erase_key = [&](std::string_view key) {
        shot.erase(key);
        if (toml::array* const keys = shot["key"].as_array())
            for (toml::node& keyframe : *keys)
                if (toml::table* const table = keyframe.as_table()) table->erase(key);
    };
    for (const auto& [key, value] : changes) {
        if (key != "air" || !change_visibility(shot, value)) erase_key(key.str());
        for (const std::string_view other : replaced_by(key.str()))
            if (!changes.contains(other)) erase_key(other);
    }
    if (toml::array* const keys = shot["key"].as_array(); keys && !changes.contains("key")) {
        const auto has_no_values = [](const toml::node& key) {
            const toml::table* const table = key.as_table();
            return table && std::ranges::all_of(*table, [](const auto& entry) {
                       return entry.first == "time_s" || entry.first == "interpolation";
                   });
        };
        for (auto key = keys->begin(); key != keys->end();)
            key = has_no_values(*key) ? keys->erase(key) : std::next(key);
        if (keys->empty()) shot.erase("key");
    }
    // Changed keys are absent by now, except a table [air] with its new visibility, which insert keeps.
    for (const auto& [key, value] : changes) shot.insert(key, value);
}

/// Settings of a stage's camera that apply where the shot file does not specify them.
class StageSettings {
public:
    /// `table`: the shot file with its changes; `shown`: the same table; `scene`: the stage.
    StageSettings(const toml::table& table, const ShotTable& shown, const std::string& scene) {
        if (table.contains("position_m") || table.contains("look_at_m") || table.contains("pose")) return;
        const std::string camera = shown.text("camera");
        if (camera == "none") return;
        io::SceneFileOptions options;
        options.scale = shown.number("scale").value_or(1);
        options.variants = shown.texts("variants");
        values_ =
            io::parse_toml(io::stage_reader(scene).camera_settings(scene, options, camera), scene, ShotTable::fail_at);
        focus_is_to_pupil_ = values_.erase("focus_is_to_pupil") > 0;
    }

    /// Adds the settings that a shot file neither has nor excludes.
    void add_to(toml::table& table) {
        toml::table merged = values_;
        apply_changes(merged, table);
        for (const auto& [name, value] : merged) {
            if (table.contains(name)) continue;
            table.insert(name, value);
            added_.emplace_back(name.str());
        }
    }

    /// Gives the stage's film the aspect ratio of a specified resolution; its width stays. Marks focus distances of the
    /// stage that are measured to the entrance pupil, and f-number and film size as those of another lens if the stage
    /// has no lens, or the shot file another one.
    void adapt(ShotRequest& request) const {
        const auto has = [&](const char* key) { return std::ranges::count(added_, key) > 0; };
        if (has("film_mm") && request.resolution) {
            const auto [columns, rows] = *request.resolution;
            (*request.film_mm)[1] = (*request.film_mm)[0] * rows / columns;
        }
        request.view_focus_is_to_pupil = focus_is_to_pupil_ && has("focus_m");
        request.key_focus_is_to_pupil = focus_is_to_pupil_ && has("key");
        if (has("lens")) return;
        request.f_number_is_of_other_lens |= has("f_number");
        request.film_is_of_other_lens |= has("film_mm");
    }

private:
    toml::table values_;
    bool focus_is_to_pupil_ = false;  // instead of to the film
    std::vector<std::string> added_;  // keys
};

/// Parses the text of a shot file. `scene`: the file to photograph instead of that of the text; empty: none.
ShotRequest parse(std::string_view text, const std::string& path, const ShotChanges& changes,
                  const std::string& scene) {
    toml::table table = io::parse_toml(text, path, ShotTable::fail_at);
    Changes changed;
    if (!changes.toml.empty()) changed.values = io::parse_toml(changes.toml, path, ShotTable::fail_at);
    for (const auto& [key, word] : changes.options) changed.values.insert_or_assign(key->name, word);
    if (!changes.options.empty()) changed.name = option_of;
    if (!changed.values.empty()) apply_changes(table, changed.values);
    const ShotTable shown(table, path, &changed);
    reject_unknown_keys(shown);
    parse_option_texts(table, shown);
    const std::string stage = scene.empty() ? shown.path("scene") : scene;
    std::optional<StageSettings> stage_settings;
    if (io::is_stage(stage) && io::has_stage_reader()) {
        stage_settings.emplace(table, shown, stage);
        stage_settings->add_to(table);
    }
    ShotRequest request = ShotReader(table, path, changed).read();
    if (!scene.empty()) request.scene = scene;
    if (stage_settings) stage_settings->adapt(request);
    return request;
}

}  // namespace

void check_environment(Vec3f v) {
    constexpr float kMaxRadiance_cd_m2 = 1e20f;  // same limit as in scene_checks.hpp
    const auto is_valid = [](float c) { return c >= 0 && c <= kMaxRadiance_cd_m2; };
    if (!is_valid(v.x) || !is_valid(v.y) || !is_valid(v.z))
        throw InputError("an environment's radiance must lie between 0 and 1e20 cd/m^2");
}

bool is_shot_file(const std::string& path) {
    return fs::path(path).extension() == ".toml";
}

ShotRequest parse_shot(std::string_view text, const std::string& path, const ShotChanges& changes) {
    return parse(text, path, changes, "");
}

ShotRequest shot_of_scene(const std::string& path, const ShotChanges& changes) {
    return parse("format = 1\nscene = \"scene\"\n", path, changes, path);
}

ShotRequest read_shot(const std::string& path, const ShotChanges& changes) {
    if (!is_shot_file(path) && !fs::is_directory(path)) return shot_of_scene(path, changes);
    const std::string why = io::why_unreadable(path);
    if (!why.empty()) throw InputError(path + ": " + why);
    if (fs::file_size(path) > kMaxBytes) throw InputError(path + ": is too large for a shot file");
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_shot(text, path, changes);
}

}  // namespace realcam::shot
