// Commands of .seq files beyond those of a plain list of surfaces.

#include <cmath>
#include <ctime>
#include <string>

#include "about.hpp"
#include "io/lens_reading.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

std::string with_private_glass(const std::string& lines, const std::string& glass) {
    return replaced(replaced(kCodeV, "SO 0.0", "PRV\nPWL 656.3 587.6 486.1\n" + lines + "END\nSO 0.0"), "NBK7_SCHOTT",
                    glass);
}

}  // namespace

TEST_CASE("a private glass by Laurent's formula has its indices") {
    // Norland's NOA61, as makers' files have it: n^2 = A0 + A1 l^2 + A2 / l^2 + A3 / l^4 + A4 / l^6 + A5 / l^8.
    const std::string line = "'NOA61' LAU 2.36390625 0.0 0.025493134 -0.000580235 -0.349933e-5 0.445404e-7\n";
    const Reading reading = read(with_private_glass(line, "'NOA61'"), "a.seq");
    REQUIRE(reading.error == "");
    const Glass& glass = reading.lens.surfaces.at(0).material;
    CHECK(glass.label == "NOA61");
    for (double nm = 305; nm < 2400; nm += 61) {
        const double x = 1e6 / (nm * nm);
        const double square =
            2.36390625 + x * (0.025493134 + x * (-0.000580235 + x * (-0.349933e-5 + x * 0.445404e-7)));
        CAPTURE(nm);
        CHECK(std::fabs(glass.index(nm) - std::sqrt(square)) < 1e-7);  // what the reader promises
    }
    CHECK(glass.index(587.6) == about(1.55974, 0.5e-5 / 1.55974));
    // A term of l^2, as infrared fits have it.
    const Reading infrared = read(with_private_glass("'X' LAU 2.7 -0.01 0.02\n", "'X'"), "a.seq");
    REQUIRE(infrared.error == "");
    CHECK(infrared.lens.surfaces.at(0).material.index(1555) ==
          about(std::sqrt(2.7 - 0.01 * 1.555 * 1.555 + 0.02 / (1.555 * 1.555)), 1e-7));
}

TEST_CASE("a private glass that cannot be read is refused where a surface has it, and nowhere else") {
    const LensSystem plain = read(kCodeV, "a.seq").lens;
    for (const char* line : {"'X' LAU 2.4 0 0.02\n", "'X' XYZ 1 2 3\n", "'X' LAU a b\n", "'X' 1.5\n", "'X'\n",
                             "'X' 1.5 nan 1.5\n", "'X' LAU -1\n", "PWL 1 a\n", "'X' HAR 1.5 0.1 0.2\n"}) {
        CAPTURE(line);
        CHECK(read(with_private_glass(line, "NBK7_SCHOTT"), "a.seq").lens == plain);
    }
    const Reading formula = read(with_private_glass("'X' HAR 1.5 0.1 0.2\n", "'X'"), "a.seq");
    CHECK(formula.says("a.seq:14: surface 2: the private glass \"X\" is specified by the unknown formula \"HAR\""));
    CHECK(read(with_private_glass("'X' 1.5\n", "'X'"), "a.seq").says("has 1 indices for 3 wavelengths"));
    CHECK(read(with_private_glass("'X' HAR 1\n", "'X'"), "a.seq", with_glass("X=1.6,50")).error == "");
}

TEST_CASE("commands that make another lens are refused by their names and lines") {
    for (const char* command : {"DEL S1", "DEL S1..2", "INS S2", "SCA 2", "SCA S1..3 FAC 2", "FLY S1..2", "REV S1..2",
                                "del s1", "RES other.len", "IN other.seq", "COP S1 S3", "AUT", "LEN NEW", "DELETE S1",
                                "XYZ S2", "XYZ S1..3 4", "XYZ SA 1"}) {
        CAPTURE(command);
        const Reading reading = read(replaced(kCodeV, "GO\n", std::string(command) + "\nGO\n"), "a.seq");
        CHECK(reading.says("a.seq:17"));
        CHECK((reading.says("the command ") || reading.says("the unknown command ")));
        CHECK(reading.can_be_forced);
    }
    const Reading last = read(kCodeV + "DEL S1\n", "a.seq");
    CHECK(last.says("a.seq:18: has the command DEL S1, which makes another lens"));
    CHECK(read(replaced(kCodeV, "GO\n", "S1..2 3 4\nGO\n"), "a.seq").says("a range of surfaces"));
    CHECK(read(replaced(kCodeV, "GO\n", "THI S1..2 4\nGO\n"), "a.seq").says("a range of surfaces"));
    CHECK(read(replaced(kCodeV, "GO\n", "DIM I\nGO\n"), "a.seq").says("DIM must precede the surfaces"));
    // Commands that change a single surface are applied.
    const LensSystem thicker = read(replaced(kCodeV, "GO\n", "THI S2 7\nRDY S2 60\nGO\n"), "a.seq").lens;
    CHECK(thicker.surfaces.at(0).thickness == 7);
    CHECK(1 / thicker.surfaces.at(0).curvature == about(60, 1e-15));
    const LensSystem moved = read(replaced(kCodeV, "GO\n", "STO S3\nGO\n"), "a.seq").lens;
    CHECK(moved.stop_index() == 1);  // in front of the back face, and no longer behind the lens
    const std::string asphere = replaced(kCodeV, "  CIR 8.0\n", "  CIR 8.0\n  ASP\n  K -1\n  A 1e-5\n");
    CHECK(read(asphere, "a.seq").lens.surfaces.at(0).is_asphere());
    CHECK(read(replaced(asphere, "GO\n", "SPH S2\nGO\n"), "a.seq").lens == read(kCodeV, "a.seq").lens);
}

TEST_CASE("an obscuration in a .seq file") {
    const Reading reading = read(replaced(kCodeV, "S 0.0 3.0\n", "S 0.0 3.0\n  CIR OBS 1.0\n"), "a.seq");
    REQUIRE(reading.error == "");
    REQUIRE(reading.lens.surfaces.size() == 4);
    CHECK(reading.lens.surfaces[0].inner_semi_diameter == 1);
    CHECK(reading.lens.surfaces[0].clear_semi_diameter > 8);  // as large as the lens behind it, and more
}

TEST_CASE("long files of other programs take time in proportion to their length") {
    // An error after a quarter of a second for a megabyte, sixteen times as many bytes at most in 32 times the time and
    // a half second of grace: squared, they would take 256 times as long.
    const auto repeated = [](const std::string& line, std::size_t bytes) {
        std::string text;
        while (text.size() < bytes) text += line;
        return text;
    };
    const auto seconds = [](const std::string& text, const std::string& file) {
        const std::clock_t start = std::clock();  // of the processor, whatever else the machine does
        const Reading reading = read(text, file);
        CHECK(reading.error.size() < 3000);
        for (const std::string& warning : reading.warnings) CHECK(warning.size() < 3000);
        return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    };
    const std::string head = kCodeV.substr(0, kCodeV.find("GO\n"));
    struct Kind {
        const char *name, *file;
        std::string before, line, after;
    };
    const std::vector<Kind> kinds{{"continued lines", "a.seq", "", "x&\n", ""},
                                  {"continued blanks", "a.seq", "", " &\n", ""},
                                  {"continued lines of a lens", "a.seq", head, "x &\n", "\nGO\n"},
                                  {"commands", "a.seq", head, "TIT x;", "\nGO\n"},
                                  {"unknown commands", "a.seq", head, "QQQ 1\n", "GO\n"},
                                  {"glasses", "a.seq", "PRV\nPWL 500\n", "'A' LAU x\n", "END\n" + head},
                                  {"wavelengths", "a.seq", "WL ", "500 ", "\n" + head},
                                  {"pickups", "a.seq", head, "PIK RDY S2 S1\n", "GO\n"},
                                  {"tilts", "a.seq", head, "XDE S2 1\n", "GO\n"},
                                  {"remarks", "a.seq", "", "! ;;\n", head},
                                  {"keywords", "a.zmx", kZemax, "QQQQ 1\n", ""},
                                  {"catalogues", "a.zmx", "", "GCAT A\n", kZemax},
                                  {"decentres", "a.zmx", kZemax, "  OBDC 1 1\n", ""},
                                  {"coatings", "a.zmx", kZemax, "  COAT A\n", ""},
                                  {"blanks", "a.zmx", "", "     \n", kZemax},
                                  {"notes", "a.len", "LEN NEW \"a\" 1 2\n", "DES \"a\"\n", "END 2\n"},
                                  {"commands of OSLO", "a.len", "LEN NEW \"a\" 1 2\n", "XX 1;", "\nNXT\nNXT\nEND 2\n"},
                                  {"rows", "a.dat", "", "# a\n", "1 2 3 4\n"},
                                  {"members", "a.json", "{", "\"a\": 1,", "\"b\": 2}"}};
    for (const Kind& kind : kinds) {
        CAPTURE(kind.name);
        const auto text = [&](std::size_t bytes) { return kind.before + repeated(kind.line, bytes) + kind.after; };
        const double one = seconds(text(1 << 16), kind.file), many = seconds(text(1 << 20), kind.file);
        CHECK(many < 32 * one + 0.5);
    }
}

TEST_CASE("a glass that follows REFL ends the reflection") {
    const LensSystem lens = read(kCodeV, "a.seq").lens;
    const std::string mirror = replaced(kCodeV, "GO\n", "GLA S2 REFL\n");
    for (const char* commands : {"GLA S2 NBK7_SCHOTT\n", "RMD S2 REFR\n"}) {
        CAPTURE(commands);
        CHECK(read(mirror + commands + "GO\n", "a.seq").lens == lens);
    }
}
