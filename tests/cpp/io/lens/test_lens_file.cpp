// Lens files: that the bundled ones are whole, and the messages about invalid ones.

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_text.hpp"
#include "optics/prescription/lens_checks.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

// A lens file that can be read, line by line; tests change single lines of it.
const std::vector<std::string> kGoodLines = {"format = 1",                      // 1
                                             "name = \"probe\"",                // 2
                                             "film_distance_mm = 50.0",         // 3
                                             "",                                // 4
                                             "[[surface]]",                     // 5
                                             "radius_of_curvature_mm = 50.0",   // 6
                                             "thickness_mm = 4.0",              // 7
                                             "material = 1.5",                  // 8
                                             "clear_semi_diameter_mm = 8.0",    // 9
                                             "",                                // 10
                                             "[[surface]]",                     // 11
                                             "type = \"stop\"",                 // 12
                                             "thickness_mm = 1.0",              // 13
                                             "clear_semi_diameter_mm = 6.0",    // 14
                                             "",                                // 15
                                             "[[surface]]",                     // 16
                                             "radius_of_curvature_mm = -60.0",  // 17
                                             "clear_semi_diameter_mm = 8.0",    // 18
                                             ""};                               // 19

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    return text;
}

std::string with_line(int number, const std::string& replacement) {
    std::vector<std::string> lines = kGoodLines;
    lines[static_cast<std::size_t>(number) - 1] = replacement;
    return joined(lines);
}

// Message of the error for a text, or "(no error)".
std::string file_complaint(const std::string& text) {
    return message_of<LensFileError>([&] { io::parse_lens(text, "probe.toml"); });
}

std::string complaint_about_name(const std::string& name) {
    return message_of<LensFileError>([&] { io::read_lens(name); });
}

// Checks that the message is one line, begins with `place` and contains `part`.
void check_complaint(const std::string& text, const std::string& place, const std::string& part) {
    const std::string message = file_complaint(text);
    CAPTURE(message);
    CHECK(message.rfind(place + ": ", 0) == 0);
    CHECK(contains(message, part));
    CHECK(!contains(message, "\n"));
}

}  // namespace

TEST_CASE("the lens that the bad ones are made from is good") {
    const LensSystem lens = io::parse_lens(joined(kGoodLines), "probe.toml");
    CHECK(lens.name == "probe");
    CHECK(lens.surfaces.size() == 3);
    CHECK(lens.stop_index() == 1);
    CHECK(lens.film_distance == 50);
    CHECK(lens.surfaces[0].curvature == 0.02);
    // The stop is inside the glass: the medium behind it is the same.
    CHECK(lens.indices(550)[1] == 1.5);
    CHECK(lens.indices(550)[2] == 1.5);
    CHECK(lens.indices(550)[3] == 1.0);
    // With the line ends of another system, and a mark at the start.
    std::string text = "\xEF\xBB\xBF";
    for (const char c : joined(kGoodLines)) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    CHECK(file_complaint(text) == "(no error)");
}

TEST_CASE("bad numbers of a surface are named with file, line and surface") {
    check_complaint(with_line(9, "clear_semi_diameter_mm = -8.0"), "probe.toml:5: surface 1",
                    "expected a positive length");
    check_complaint(with_line(9, "clear_semi_diameter_mm = 0.0"), "probe.toml:5: surface 1",
                    "is 0 mm; expected a positive length");
    check_complaint(with_line(14, "clear_semi_diameter_mm = nan"), "probe.toml:14: surface 2",
                    "must be a finite number");
    check_complaint(with_line(18, "clear_semi_diameter_mm = 61.0"), "probe.toml:16: surface 3",
                    "larger than the surface, which ends at 60 mm from");
    check_complaint(with_line(7, "thickness_mm = -4.0"), "probe.toml:5: surface 1", "the thickness is negative");
    check_complaint(with_line(7, "thickness_mm = nan"), "probe.toml:7: surface 1", "must be a finite number");
    check_complaint(with_line(7, "thickness_mm = inf"), "probe.toml:7: surface 1", "must be a finite number");
    check_complaint(with_line(7, "thickness_mm = \"4\""), "probe.toml:7: surface 1", "must be a finite number");
    check_complaint(with_line(7, ""), "probe.toml:5: surface 1", "\"thickness_mm\" is missing");
    check_complaint(with_line(19, "thickness_mm = 2.0"), "probe.toml:19: surface 3",
                    "the last surface has no \"thickness_mm\"");
    check_complaint(with_line(9, ""), "probe.toml:5: surface 1", "\"clear_semi_diameter_mm\" is missing");
    check_complaint(with_line(6, "radius_of_curvature_mm = 0"), "probe.toml:6: surface 1",
                    "a radius of curvature must not be 0");
    check_complaint(with_line(6, "radius_of_curvature_mm = nan"), "probe.toml:6: surface 1", "must be a finite number");
    check_complaint(with_line(10, "inner_semi_diameter_mm = 8.0"), "probe.toml:5: surface 1",
                    "less than the clear semi-diameter");
    check_complaint(with_line(10, "aspheric_coefficients = { 5 = 1e-5 }"), "probe.toml:10: surface 1",
                    "even powers from 4 to 18");
    check_complaint(with_line(10, "aspheric_coefficients = { \"\" = 1e-5 }"), "probe.toml:10: surface 1",
                    "even powers from 4 to 18");
    check_complaint(with_line(10, "aspheric_coefficients = { 44444444444444444444 = 1e-5 }"),
                    "probe.toml:10: surface 1", "even powers from 4 to 18");
    check_complaint(with_line(10, "aspheric_coefficients = { 4 = nan }"), "probe.toml:10: surface 1", "r^4");
    check_complaint(with_line(10, "conic = inf"), "probe.toml:10: surface 1", "must be a finite number");
    check_complaint(with_line(12, "type = \"stopp\""), "probe.toml:12: surface 2", "unknown type \"stopp\"");
    check_complaint(with_line(15, "radius_of_curvature_mm = 10.0"), "probe.toml:15: surface 2", "unknown key");
    check_complaint(with_line(10, "radius_mm = 4.0"), "probe.toml:10: surface 1", "unknown key \"radius_mm\"");
    check_complaint(with_line(7, "thicknes_mm = 4.0"), "probe.toml:7: surface 1", "did you mean \"thickness_mm\"");
}

TEST_CASE("bad materials are named with file, line and surface") {
    check_complaint(with_line(8, "material = -1.5"), "probe.toml:8: surface 1", "less than 1");
    check_complaint(with_line(8, "material = 0"), "probe.toml:8: surface 1", "less than 1");
    check_complaint(with_line(8, "material = nan"), "probe.toml:8: surface 1", "must be a finite number");
    check_complaint(with_line(8, "material = 150"), "probe.toml:5: surface 1", "expected 1 to 10");
    check_complaint(with_line(8, "material = [1.5, -60.0]"), "probe.toml:8: surface 1", "a positive V_d");
    check_complaint(with_line(8, "material = [1.5]"), "probe.toml:8: surface 1", "an array of 2 numbers");
    check_complaint(with_line(8, "material = \"N-BK77\""), "probe.toml:8: surface 1", "\"N-BK7\"");
    check_complaint(with_line(8, "material = \"F4\""), "probe.toml:8: surface 1", "several catalogues");
    check_complaint(with_line(8, "material = \"schott:N-XX99\""), "probe.toml:8: surface 1",
                    "unknown glass \"schott:N-XX99\"");
    check_complaint(with_line(8, "type = \"mirror\""), "probe.toml:5: surface 1", "light travels back behind a mirror");
    check_complaint(with_line(19, "type = \"mirror\""), "probe.toml:16: surface 3", "odd number of mirrors");
    check_complaint(with_line(19, "type = \"mirror\"\nmaterial = 1.5"), "probe.toml:20: surface 3",
                    "a mirror has no material");
    const std::string own = "[glass.OWN]\n";
    check_complaint(with_line(8, "material = \"OWN\"") + own + "n_d = 1.5\n", "probe.toml:20",
                    "must be specified together");
    check_complaint(with_line(8, "material = \"OWN\"") + own + "n_d = 1.5\nV_d = 0.0\n", "probe.toml:22",
                    "must be positive");
    check_complaint(with_line(8, "material = \"OWN\"") + own + "index = 1.5\ncauchy = [1.5]\n", "probe.toml:20",
                    "exactly one of");
    check_complaint(with_line(8, "material = \"OWN\"") + own + "table = [[500, 1.5], [500, 1.6]]\n", "probe.toml:21",
                    "twice");
    check_complaint(with_line(8, "material = \"OWN\"") + own + "sellmeier = { B = [1.0, 2.0], C = [0.01] }\n",
                    "probe.toml:21", "equally many");
}

TEST_CASE("bad lenses are named with their file") {
    check_complaint(with_line(12, "type = \"aperture\""), "probe.toml:5", "no surface of type \"stop\"");
    check_complaint(joined(kGoodLines) + "type = \"stop\"\n", "probe.toml:17: surface 3", "unknown key");
    std::vector<std::string> two = kGoodLines;
    two.insert(two.begin() + 14,
               {"[[surface]]", "type = \"stop\"", "thickness_mm = 1.0", "clear_semi_diameter_mm = 6.0"});
    check_complaint(joined(two), "probe.toml:15: surface 3",
                    "a second \"stop\", after surface 2; expected exactly one");
    check_complaint(with_line(3, "film_distance_mm = -5.0"), "probe.toml:3", "the film lies behind the last surface");
    // The film of an eye, or on a cover glass, touches the last surface.
    CHECK(file_complaint(with_line(3, "film_distance_mm = 0.0")) == "(no error)");
    std::vector<std::string> diverging = kGoodLines;
    diverging[2] = "";
    diverging[5] = "radius_of_curvature_mm = -50.0";
    diverging[16] = "radius_of_curvature_mm = 60.0";
    check_complaint(joined(diverging), "probe.toml:1", "no real image of infinity");
    check_complaint(with_line(1, ""), "probe.toml:1", "\"format = 1\" is missing");
    check_complaint(with_line(1, "format = 2"), "probe.toml:1", "format 2");
    check_complaint(with_line(2, ""), "probe.toml:1", "\"name\" is missing");
    check_complaint(with_line(2, "name = 5"), "probe.toml:2", "must be a text");
    check_complaint(with_line(4, "colour = 1"), "probe.toml:4", "unknown key \"colour\"");
    check_complaint(with_line(4, "wavelength_nm = -5"), "probe.toml:4", "between 100 and 20000");
    check_complaint(with_line(4, "film_mm = [36.0]"), "probe.toml:4", "2 numbers");
    check_complaint(with_line(4, "film_mm = [36.0, -24.0]"), "probe.toml:4", "positive lengths");
    check_complaint(joined(kGoodLines) + "[iris]\nblades = 2\n", "probe.toml:20", "2 blades");
    check_complaint(joined(kGoodLines) + "[iris]\nblades = 5.5\n", "probe.toml:21", "whole number");
    check_complaint(joined(kGoodLines) + "[iris]\nblades = 5\nrounding = 1.5\n", "probe.toml:20", "rounding");
    check_complaint(joined(kGoodLines) + "[focus]\ngroup = [2, 9]\n", "probe.toml:21", "focusing group");
    check_complaint(joined(kGoodLines) + "[focus]\ngroup = [3, 1]\n", "probe.toml:21", "focusing group");
    check_complaint(joined(kGoodLines) + "[focus]\ngroup = [1e18, 2]\n", "probe.toml:21", "first and last surface");
    check_complaint(joined(kGoodLines) + "[focus]\ngroup = [1, -1e18]\n", "probe.toml:21", "first and last surface");
    check_complaint(joined(kGoodLines) + "[focus]\nnearest_m = -1.0\n", "probe.toml:21", "positive distance");
    for (const char* distance : {"1e10", "1e308"})
        check_complaint(with_line(3, "film_distance_mm = " + std::string(distance)), "probe.toml:3", "at most 1e9 mm");
    for (const char* line :
         {"name = \"a\\u0000b\"", "name = \"a\\u001b[31m\"", "name = \"a\\u009bm\"", "name = \"a\\nb\""})
        check_complaint(with_line(2, line), "probe.toml:2", "without control characters");
    CHECK(file_complaint(with_line(2, "name = \"Objektiv f\u00fcr 50 \u00b5m $\"")) == "(no error)");
    check_complaint(with_line(4, "title = \"a\\u0000b\""), "probe.toml:4", "one line of text");
    check_complaint("", "probe.toml:1", "is missing");
    check_complaint("format = 1\nname = \"x\"\n", "probe.toml:1", "the lens has no surfaces");
    check_complaint("format = 1\nname = \"x\"\nsurface = 3\n", "probe.toml:1", "the lens has no surfaces");
    check_complaint("format = 1\nname = \"x\"\nsurface = []\n", "probe.toml:1", "no surfaces");
}

TEST_CASE("faces that cross are named with file, line and surface, and allowed where the file says so") {
    // The stop between them has no substance: the faces' sags at 8 mm are 0.644 and -0.536 mm.
    const std::string thin = with_line(7, "thickness_mm = 0.1");
    check_complaint(thin, "probe.toml:5: surface 1", "crosses surface 3, by 0.0799 mm at 8 mm from the axis");
    CHECK(file_complaint(with_line(7, "thickness_mm = 0.2")) == "(no error)");
    const std::string allowed = "allow_overlap = true\n" + thin;
    CHECK(file_complaint(allowed) == "(no error)");
    CHECK(io::parse_lens(allowed, "probe.toml").allow_overlap);
    CHECK(!io::parse_lens(joined(kGoodLines), "probe.toml").allow_overlap);
    check_complaint("allow_overlap = 1\n" + thin, "probe.toml:1", "must be true or false");
    // The film, half of whose diagonal is 21.6 mm, cuts through a last face whose rim is 0.536 mm behind its vertex.
    const std::string hollow = "radius_of_curvature_mm = 60.0";
    std::vector<std::string> lines = kGoodLines;
    lines[16] = hollow;
    lines[2] = "film_distance_mm = 0.5";
    check_complaint(joined(lines), "probe.toml:3", "cuts through its last face");
    lines[2] = "film_distance_mm = 0.54";
    CHECK(file_complaint(joined(lines)) == "(no error)");
}

TEST_CASE("text that is not TOML is named with file and line") {
    check_complaint(with_line(9, "clear_semi_diameter_mm = = 8"), "probe.toml:9", "not valid TOML");
    check_complaint(with_line(11, "[[surface]"), "probe.toml:11", "not valid TOML");
    check_complaint(with_line(8, "material = 1.5\nmaterial = 1.6"), "probe.toml:9", "not valid TOML");
    check_complaint(with_line(7, "thickness_mm\u00e9 = 4.0"), "probe.toml:7", "not valid TOML");
    check_complaint(with_line(9, "allow_overlap = f"), "probe.toml:9", "not valid TOML");
    CHECK(!contains(file_complaint(with_line(9, "allow_overlap = f")), "\n"));
    CHECK(file_complaint(with_line(9, std::string(100000, 'x') + " = 1")).size() < 300);
    check_complaint(std::string("\x7f\x45LF\x02\x01\0\0\xff\xfe", 10), "probe.toml:1", "not valid TOML");
}

TEST_CASE("a lens that is not there is named, with the nearest names") {
    const std::string misspelt = complaint_about_name("duble-gauss-50mm");
    CAPTURE(misspelt);
    CHECK(contains(misspelt, "unknown lens \"duble-gauss-50mm\""));
    CHECK(contains(misspelt, "\"double-gauss-50mm\""));
    CHECK(contains(complaint_about_name("tessar"), "\"tessar-50mm\""));
    CHECK(contains(complaint_about_name("tesar"), "\"tessar-50mm\""));
    CHECK(!contains(complaint_about_name("qqqqqqqqqqqqqqqq"), "did you mean"));
    CHECK(contains(complaint_about_name("qqqqqqqqqqqqqqqq"), "a bundled lens"));
    CHECK(contains(complaint_about_name("/nowhere/lens.toml"), "/nowhere/lens.toml: no such file"));
    CHECK(contains(complaint_about_name("/"), "is a folder"));
    const auto path = std::filesystem::temp_directory_path() / ("realcam-lens-" + std::to_string(getpid()) + ".toml");
    std::ofstream(path) << with_line(7, "thickness_mm = -4.0");
    CHECK(complaint_about_name(path.string()).rfind(path.string() + ":5: surface 1: ", 0) == 0);
    std::ofstream(path) << joined(kGoodLines);
    CHECK(io::read_lens(path.string()).name == "probe");
    std::filesystem::remove(path);
}

TEST_CASE("every bundled lens is valid and cites its source") {
    const std::vector<std::string> names = io::lens_names();
    CHECK(names.size() >= 40);
    for (const std::string& name : names) {
        CAPTURE(name);
        const LensSystem lens = io::read_lens(name);
        CHECK_NOTHROW(validate(lens));
        CHECK(lens.name == name);
        CHECK(lens.source.size() > 20);
        CHECK(!lens.title.empty());
        CHECK(lens.film_distance != 0);
        CHECK(lens.is_wide_open());
    }
}
