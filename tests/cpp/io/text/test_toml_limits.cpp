// TOML that is nested without end, and lens files whose values lie at the ends of their ranges.

#include <cmath>
#include <string>
#include <vector>

#include "about.hpp"
#include "io/lens_reading.hpp"
#include "io/sensor/sensor_file.hpp"
#include "refusal.hpp"
#include "shot/shot_file.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

std::string repeated(const std::string& part, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += part;
    return text;
}

/// A zoom lens with all kinds of keys. `name` = value may be changed.
const std::string kZoom = R"(format = 1
name = "zoom"
wavelength_nm = 550.0
film_mm = [36.0, 24.0]
zoom_position = "wide"
focus_distance_mm = 2000.0
stop_semi_diameter_mm = 3.0
[iris]
blades = 7
rounding = 0.5
rotation_deg = 10.0
[focus]
nearest_m = 0.5
[glass.mine]
n_d = 1.6
V_d = 50.0
[glass.formula]
sellmeier = { B = [1.04, 0.23], C = [0.006, 0.02] }
[glass.series]
cauchy = [1.5, 0.004]
[coating.film]
layers = [{ material = 1.38, thickness_nm = 99.6 }]
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 4.0
material = "mine"
clear_semi_diameter_mm = 8.0
conic = -0.2
aspheric_coefficients = { 4 = 1e-7 }
coating = "film"
[[surface]]
radius_of_curvature_mm = -200.0
thickness_mm = 10.0
clear_semi_diameter_mm = 8.0
inner_semi_diameter_mm = 0.1
[[surface]]
type = "stop"
thickness_mm = 5.0
clear_semi_diameter_mm = 4.0
[[surface]]
curvature_per_mm = -0.006
thickness_mm = 2.0
material = "formula"
clear_semi_diameter_mm = 7.0
[[surface]]
thickness_mm = 2.0
material = "series"
clear_semi_diameter_mm = 7.0
[[surface]]
clear_semi_diameter_mm = 7.0
[[zoom]]
name = "wide"
thickness_mm = { 3 = 5.0 }
film_distance_mm = 60.0
focus_distance_mm = 3000.0
stop_semi_diameter_mm = 4.0
[[zoom]]
name = "tele"
thickness_mm = { 3 = 9.0 }
film_distance_mm = 61.0
stop_semi_diameter_mm = 3.5
)";

}  // namespace

TEST_CASE("TOML that is nested without end is an error of one line, from all that read it") {
    const int many = 150000;
    struct Kind {
        const char* name;
        std::string text;
        int line;
    };
    const std::vector<Kind> kinds{
        {"a dotted key", "format = 1\na" + repeated(".a", many) + " = 1\n", 2},
        {"blanks around the dots", "a" + repeated(" . a", many) + " = 1\n", 1},
        {"quoted parts", "\"a\"" + repeated(".\"a\"", many) + " = 1\n", 1},
        {"a header", "\n\n[a" + repeated(".a", many) + "]\n", 3},
        {"a header of an array", "[[a" + repeated(".a", many) + "]]\n", 1},
        {"inline tables", "a = " + repeated("{ a = ", many) + "1" + repeated("}", many) + "\n", 1},
        {"arrays", "a = " + repeated("[", many) + repeated("]", many) + "\n", 1},
        {"arrays on lines", "a = " + repeated("[\n", many) + repeated("]", many) + "\n", 101},
        {"tables and keys by turns", "a = " + repeated("{ a.a.a = ", many) + "1\n", 1},
        {"an inline table with a dotted key", "a = { b" + repeated(".b", many) + " = 1 }\n", 1}};
    for (const Kind& kind : kinds) {
        CAPTURE(kind.name);
        const std::string place = ":" + std::to_string(kind.line) + ": is nested too deeply";
        for (const std::string& message : {message_of<Error>([&] { io::parse_lens(kind.text, "a.toml"); }),
                                           message_of<Error>([&] { io::parse_sensor(kind.text, "a.toml"); }),
                                           message_of<Error>([&] { shot::parse_shot(kind.text, "a.toml"); })}) {
            CHECK(message.find("a.toml" + place) == 0);
            CHECK(message.find('\n') == std::string::npos);
        }
    }
    // Text that only looks nested is accepted, and so are 50 levels.
    for (const std::string& text :
         {"a = \"" + repeated("[.", many) + "\"\n", "a = '" + repeated("{.", many) + "'\n",
          "a = \"\"\"\n" + repeated("[.\"\n", many) + "\"\"\"\n", "# " + repeated("[a.", many) + "\na = 1\n",
          "a = [" + repeated("1.5, ", many) + "]\n", "a = \"\\\"" + repeated("[", many) + "\"\n",
          "a" + repeated(".a", 50) + " = 1\n", "a = " + repeated("[", 50) + repeated("]", 50) + "\n"}) {
        const std::string message = message_of<Error>([&] { io::parse_lens(text, "a.toml"); });
        CAPTURE(text.substr(0, 20));
        CHECK(message.find("unknown key \"a\"") != std::string::npos);
    }
}

TEST_CASE("what a lens file may say is read again after it is saved") {
    REQUIRE(read(kZoom, "a.toml").error == "");
    const std::vector<std::string> values{"0",
                                          "-0.0",
                                          "0.0",
                                          "1",
                                          "-1",
                                          "1e-320",
                                          "1e-300",
                                          "1e-7",
                                          "1e-6",
                                          "0.1",
                                          "3",
                                          "3.9",
                                          "4",
                                          "1e3",
                                          "1e6",
                                          "1e9",
                                          "1.1e9",
                                          "1e37",
                                          "1e38",
                                          "1e300",
                                          "1e308",
                                          "-1e308",
                                          "inf",
                                          "-inf",
                                          "nan",
                                          "9007199254740993",
                                          "9223372036854775807",
                                          "true",
                                          "\"a\"",
                                          "\"\\u0007\"",
                                          "\"\\u0085\"",
                                          "[]",
                                          "[1.0, 1.0]"};
    int accepted = 0;
    std::size_t line_begin = 0;
    while (line_begin < kZoom.size()) {
        const std::size_t line_end = kZoom.find('\n', line_begin);
        const std::string line = kZoom.substr(line_begin, line_end - line_begin);
        const std::size_t equals = line.find(" = ");
        // The value, or each number of an array or a table.
        std::vector<std::pair<std::size_t, std::size_t>> places;
        if (equals != line.npos && line[equals + 3] != '{' && line[equals + 3] != '[')
            places.emplace_back(equals + 3, line.size());
        for (std::size_t i = equals == line.npos ? line.size() : equals + 3; i < line.size();) {
            const std::size_t begin = line.find_first_of("0123456789", i);
            if (begin == line.npos || places.size() == 1) break;
            std::size_t end = line.find_first_not_of("0123456789.e-", begin);
            if (end == line.npos) end = line.size();
            if (line.substr(end, 2) != " =") places.emplace_back(begin, end);
            i = end;
        }
        for (const auto& [begin, end] : places)
            for (const std::string& value : values) {
                std::string changed = kZoom;
                changed.replace(line_begin + begin, end - begin, value);
                const Reading first = read(changed, "a.toml");
                if (first.error != "") continue;
                ++accepted;
                CAPTURE(line);
                CAPTURE(value);
                std::string saved;
                CHECK_NOTHROW(saved = io::lens_text_for(first.lens, "a.toml").text);
                const Reading again = read(saved, "a.toml");
                CHECK(again.error == "");
                CHECK(again.lens == first.lens);
            }
        line_begin = line_end + 1;
    }
    CHECK(accepted > 100);
    CHECK(read(replaced(kZoom, "stop_semi_diameter_mm = 3.5", "stop_semi_diameter_mm = 0"), "a.toml")
              .says(": \"stop_semi_diameter_mm\" must be positive"));
    CHECK(read(replaced(kZoom, "[glass.mine]", "[glass.\"a\\nb\"]\nindex = 1.5\n[glass.mine]"), "a.toml").error == "");
    CHECK(read(replaced(replaced(kZoom, "[glass.mine]", "[glass.\"a\\nb\"]"), "\"mine\"", "\"a\\nb\""), "a.toml")
              .says("must be one line of text"));
}

TEST_CASE("long tables of a lens file are refused before they are copied to each surface") {
    const std::string rows = "[" + repeated("[500, 1.5], ", 11000) + "]";
    CHECK(read(kZoom + "[glass.x]\ntable = " + rows + "\n", "a.toml").error == "");  // which no surface has
    CHECK(read(replaced(kZoom, "n_d = 1.6\nV_d = 50.0", "table = " + rows), "a.toml").says("at most 10000 are read"));
    CHECK(read(replaced(
                   kZoom, "layers = [{",
                   "layers = [{ complex_index = [" + repeated("[500, 1.5, 0], ", 11000) + "], thickness_nm = 9 }, {"),
               "a.toml")
              .says("at most 10000 are read"));
    CHECK(read(kZoom + repeated("[[surface]]\nclear_semi_diameter_mm = 1\n", 300), "a.toml")
              .says("at most 256 are supported"));
    CHECK(read(kZoom + repeated("[[zoom]]\nname = \"a\"\n", 1001), "a.toml").says("at most 1000 are read"));
}

TEST_CASE("an ending that no lens file has is told, with those that are read") {
    for (const char* file : {"a.zar", "a.zos", "a.lens", "a.txt", "a"}) {
        const Reading reading = read("// OSLO 7.0\nLEN NEW\n", file);
        CHECK(reading.says("expected .toml, .zmx, .seq, .len, .dat, .json or .roa"));
        CHECK(read(kZoom, file).error == "");  // TOML by whatever name
    }
    CHECK(read("// OSLO\n", "a.toml").says("a.toml:1: not valid TOML"));
    CHECK(read("x", "b.zar").says("\".zar\""));
}
