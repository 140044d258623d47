#include "shot_file.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "../error.hpp"
#include "../io/printable.hpp"
#include "../io/readable_file.hpp"
#include "../io/toml_table.hpp"
#include "names.hpp"

namespace realcam::shot {
namespace {

namespace fs = std::filesystem;
using io::TomlTable;

constexpr int kFormat = 1;
/// A shot file is some lines; what is larger is something else.
constexpr std::uintmax_t kMostBytes = 1 << 20;

[[noreturn]] void fail_at(const std::string& message, const std::string& file, int line, int) {
    throw InputError(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + message);
}

/// The keys of a shot file, read into a request.
class ShotReader {
public:
    ShotReader(const toml::table& table, const std::string& path)
        : table_(table, path, 0, fail_at), folder_(fs::path(path).parent_path()) {}

    ShotRequest read() const {
        table_.allow({"format", "scene",       "scale",   "texture",         "environment", "environment_cd_m2",
                      "lens",   "f_number",    "film_mm", "resolution",      "position_m",  "look_at_m",
                      "up",     "focus_m",     "model",   "exposure_time_s", "iso",         "spp",
                      "seed",   "max_bounces", "tone",    "layers"});
        if (table_.number("format") != kFormat) table_.fail("format = " + std::to_string(kFormat) + " is wanted");
        ShotRequest shot;
        shot.scene = path("scene");
        if (shot.scene.empty()) table_.fail("scene is missing: the file to photograph");
        shot.scale = table_.number("scale").value_or(shot.scale);
        if (!(shot.scale > 0)) table_.fail("\"scale\" must be a positive number of metres", table_.find("scale"));
        read_light(shot);
        read_camera(shot);
        read_settings(shot.settings);
        return shot;
    }

private:
    void read_light(ShotRequest& shot) const {
        shot.texture = path("texture");
        shot.environment_file = path("environment");
        const toml::node* constant = table_.find("environment_cd_m2");
        if (!constant) return;
        if (!shot.environment_file.empty())
            table_.fail("environment and environment_cd_m2 exclude each other", constant);
        Vec3d rgb;
        if (constant->is_array()) {
            rgb = *point("environment_cd_m2");
        } else {
            rgb.x = rgb.y = rgb.z = *table_.number("environment_cd_m2");
        }
        shot.environment_cd_m2 = static_cast<Vec3f>(rgb);
        checked("environment_cd_m2", [&] { check_environment(*shot.environment_cd_m2); });
    }

    void read_camera(ShotRequest& shot) const {
        if (const std::string lens = name("lens"); !lens.empty())
            shot.lens = lens.find_first_of("/.") == std::string::npos ? lens : path("lens");
        shot.f_number = table_.number("f_number");
        if (const auto size = table_.numbers("film_mm", 2); !size.empty()) shot.film_mm = {size[0], size[1]};
        if (const auto pixels = table_.numbers("resolution", 2); !pixels.empty())
            shot.resolution = {whole("resolution", pixels[0]), whole("resolution", pixels[1])};
        shot.view.position_m = point("position_m");
        shot.view.look_at_m = point("look_at_m");
        shot.view.up = point("up").value_or(shot.view.up);
        shot.view.focus_distance_m = number_or_auto("focus_m", "a number of metres, inf or \"auto\"");
        shot.model = named("model", model_named, kModelNames).value_or(shot.model);
        shot.exposure_time_s = number_or_auto("exposure_time_s", "a number of seconds or \"auto\"");
        shot.iso = table_.number("iso").value_or(shot.iso);
        shot.tone = named("tone", tone_named, kToneNames).value_or(shot.tone);
    }

    /// None for the text "auto", too.
    std::optional<double> number_or_auto(const char* key, const char* wanted) const {
        const toml::node* node = table_.find(key);
        if (!node || node->value<std::string>() == "auto") return std::nullopt;
        const double number = node->is_number() ? node->value_or(0.0) : std::nan("");
        if (std::isnan(number)) table_.fail('"' + std::string(key) + "\" must be " + wanted, node);
        return number;
    }

    void read_settings(RenderSettings& settings) const {
        const auto read = [&](const char* key, auto& value) {
            using Value = std::remove_reference_t<decltype(value)>;
            if (const auto number = table_.number(key)) value = whole<Value>(key, *number);
        };
        read("spp", settings.spp);
        read("seed", settings.seed);
        read("max_bounces", settings.max_bounces);
        checked("spp", [&] { validate(settings); });
        const std::vector<std::string> layers = table_.texts("layers");
        checked("layers", [&] { settings.layers = layers_named(layers); });
    }

    template <class Value = int>
    Value whole(const char* key, double number) const {
        constexpr Value kMost = std::numeric_limits<Value>::max();
        if (number != std::floor(number) || !(number >= 0) || !(number <= kMost))
            table_.fail('"' + std::string(key) + "\" wants whole numbers from 0 to " + std::to_string(kMost),
                        table_.find(key));
        return static_cast<Value>(number);
    }

    std::optional<Vec3d> point(const char* key) const {
        const auto v = table_.numbers(key, 3);
        if (v.empty()) return std::nullopt;
        return Vec3d{v[0], v[1], v[2]};
    }

    /// Relative to the folder of the shot file.
    std::string path(const char* key) const {
        const std::string text = name(key);
        if (text.empty()) {
            if (table_.find(key)) table_.fail('"' + std::string(key) + "\" is empty", table_.find(key));
            return text;
        }
        return (folder_ / text).string();
    }

    /// The system would take what stands before a null character for the name.
    std::string name(const char* key) const {
        const std::string text = table_.text(key);
        if (text.find('\0') != std::string::npos)
            table_.fail('"' + std::string(key) + "\" holds a null character", table_.find(key));
        return text;
    }

    template <class Named>
    auto named(const char* key, Named&& find, const char* wanted) const -> decltype(find("")) {
        const std::string text = table_.text(key);
        if (!table_.find(key)) return std::nullopt;
        const auto found = find(text);
        if (!found) table_.fail('"' + std::string(key) + "\" must be " + wanted, table_.find(key));
        return found;
    }

    /// What a check of values says, with the line of the key.
    template <class Check>
    void checked(const char* key, Check&& check) const {
        try {
            check();
        } catch (const InputError& error) {
            table_.fail(error.what(), table_.find(key));
        }
    }

    TomlTable table_;
    fs::path folder_;
};

}  // namespace

void check_environment(Vec3f v) {
    constexpr float kBrightest = 1e20f;  // as scene_checks.hpp has it
    const auto good = [](float c) { return c >= 0 && c <= kBrightest; };
    if (!good(v.x) || !good(v.y) || !good(v.z))
        throw InputError("an environment's radiance must lie between 0 and 1e20 cd/m^2");
}

ShotRequest parse_shot(std::string_view text, const std::string& path) {
    try {
        const toml::table table = toml::parse(text, path);
        return ShotReader(table, path).read();
    } catch (const toml::parse_error& error) {
        fail_at("not valid TOML: " + io::printable(error.description()), path,
                static_cast<int>(error.source().begin.line), 0);
    }
}

ShotRequest read_shot_file(const std::string& path) {
    const std::string why = io::why_unreadable(path);
    if (!why.empty()) throw InputError(path + ": " + why);
    if (fs::file_size(path) > kMostBytes) throw InputError(path + ": is too large for a shot file");
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return parse_shot(text, path);
}

}  // namespace realcam::shot
