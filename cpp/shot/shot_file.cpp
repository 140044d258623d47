#include "shot_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/text/printable.hpp"
#include "../io/text/text_number.hpp"
#include "../io/text/toml_document.hpp"
#include "read_camera_keys.hpp"
#include "read_scene_request.hpp"

namespace realcam::shot {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
/// A shot file has some lines; anything larger is another kind of file.
constexpr std::uintmax_t kMostBytes = 1 << 20;

/// Keys that are not in shot_keys(): tables, and values that are read together with others.
constexpr std::string_view kTables[] = {"format", "scene", "object", "material", "light", "pose", "key", "shake"};

toml::array array_of(const std::vector<double>& values) {
    toml::array array;
    for (const double value : values) array.push_back(value);
    return array;
}

/// Passes the value of a word to `take`, unless the word is itself the value. Returns false if the word is invalid.
template <class Take>
bool take_word(Syntax syntax, const std::string& word, const Take& take) {
    const auto take_numbers = [&](char separator, std::size_t count) {
        const auto values = io::numbers_in(word, separator, count);
        if (values) take(array_of(*values));
        return values.has_value();
    };
    const auto take_number = [&](bool may_be_infinite) {
        const auto value = io::number_in(word);
        const auto fraction = value ? std::nullopt : io::numbers_in(word, '/', 2);
        if (fraction && (*fraction)[1] != 0) return take((*fraction)[0] / (*fraction)[1]), true;
        if (!value || (std::isinf(*value) && !may_be_infinite)) return false;
        return take(*value), true;
    };
    const auto take_whole = [&] {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) return false;
        return take(value), true;
    };
    switch (syntax) {
        case Syntax::text: return true;
        case Syntax::number: return take_number(false);
        case Syntax::number_or_auto: return word == "auto" || take_number(false);
        case Syntax::distance_or_auto: return word == "auto" || take_number(true);
        case Syntax::whole: return take_whole();
        case Syntax::whole_or_auto: return word == "auto" || take_whole();
        case Syntax::number_or_file: return take_number(true) || true;
        case Syntax::three_numbers: return take_numbers(',', 3);
        case Syntax::two_numbers: return take_numbers(',', 2);
        case Syntax::size: return take_numbers('x', 2);
        case Syntax::names: {
            toml::array names;
            std::istringstream list(word);
            for (std::string name; std::getline(list >> std::ws, name, ',');) names.push_back(name);
            take(names);
            return true;
        }
    }
    return false;
}

/// Parses the values of a table that are single words, as on the command line. `shot`: the same table, for messages.
/// Throws InputError.
void read_words(toml::table& table, const ShotTable& shot) {
    for (const ShotKey& key : shot_keys()) {
        const toml::node* const node = table.get(key.name);
        if (!node || !node->is_string()) continue;
        const std::string word = *node->value<std::string>();
        const auto take = [&](const auto& value) { table.insert_or_assign(key.name, value); };
        if (!take_word(key.syntax, word, take))
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
    void read_motion(ShotRequest& shot) const {
        for (const ShotTable& key : table_.tables("pose")) {
            key.allow({"time_s", "position_m", "look_at_m", "up"});
            shot.motion.push_back({key.number_wanted("time_s"),
                                   {key.point_wanted("position_m"), key.point_wanted("look_at_m"),
                                    key.point("up").value_or(shot.view.up)}});
        }
        table_.checked("pose", [&] {
            if (!shot.motion.empty()) validate(shot.motion);
        });
    }

    /// Throws InputError if keys contradict each other.
    void check(ShotRequest& shot) const {
        exclude("environment", {"environment_cd_m2"});
        exclude("zoom", {"focal_length_mm"});
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

    void exclude(const char* key, std::initializer_list<const char*> others) const {
        for (const char* const other : others)
            if (const toml::node* const node = table_.find(key) ? table_.find(other) : nullptr)
                table_.fail(table_.shown(other) + " and " + table_.shown(key) + " exclude each other", node);
    }

    ShotTable table_;
};

void allow_known(const ShotTable& table) {
    std::vector<std::string_view> names(std::begin(kTables), std::end(kTables));
    for (const ShotKey& key : shot_keys()) names.emplace_back(key.name);
    table.allow(names);
}

/// Keys that a key replaces.
std::vector<std::string_view> replaced_by(std::string_view name) {
    if (name == "pose") return {"camera", "position_m", "look_at_m"};
    for (const ShotKey& key : shot_keys())
        if (key.name == name) return key.replaces;
    return {};
}

std::string option_of(std::string_view name) {
    for (const ShotKey& key : shot_keys())
        if (key.name == name && key.option) return key.option;
    return '"' + std::string(name) + '"';
}

/// Applies the changes to a shot. They have no lines in messages: toml++ copies a node without its source.
void change(toml::table& shot, const toml::table& changes) {
    const auto forget = [&](std::string_view key) {
        shot.erase(key);
        if (toml::array* const keys = shot["key"].as_array())
            for (toml::node& of_time : *keys)
                if (toml::table* const table = of_time.as_table()) table->erase(key);
    };
    for (const auto& [key, value] : changes) {
        forget(key.str());
        for (const std::string_view other : replaced_by(key.str()))
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

void check_environment(Vec3f v) {
    constexpr float kBrightest = 1e20f;  // same limit as in scene_checks.hpp
    const auto good = [](float c) { return c >= 0 && c <= kBrightest; };
    if (!good(v.x) || !good(v.y) || !good(v.z))
        throw InputError("an environment's radiance must lie between 0 and 1e20 cd/m^2");
}

bool is_shot_file(const std::string& path) {
    return fs::path(path).extension() == ".toml";
}

ShotRequest parse_shot(std::string_view text, const std::string& path, const ShotChanges& changes) {
    toml::table table = io::parse_toml(text, path, ShotTable::fail_at);
    Changes changed;
    if (!changes.toml.empty()) changed.values = io::parse_toml(changes.toml, path, ShotTable::fail_at);
    for (const auto& [key, word] : changes.options) changed.values.insert_or_assign(key->name, word);
    if (!changes.options.empty()) changed.name = option_of;
    if (!changed.values.empty()) change(table, changed.values);
    const ShotTable shown(table, path, &changed);
    allow_known(shown);
    read_words(table, shown);
    return ShotReader(table, path, changed).read();
}

ShotRequest shot_of_scene(const std::string& path, const ShotChanges& changes) {
    ShotRequest request = parse_shot("format = 1\nscene = \"scene\"\n", path, changes);
    request.scene = path;
    return request;
}

ShotRequest read_shot(const std::string& path, const ShotChanges& changes) {
    if (!is_shot_file(path) && !fs::is_directory(path)) return shot_of_scene(path, changes);
    const std::string why = io::why_unreadable(path);
    if (!why.empty()) throw InputError(path + ": " + why);
    if (fs::file_size(path) > kMostBytes) throw InputError(path + ": is too large for a shot file");
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_shot(text, path, changes);
}

}  // namespace realcam::shot
