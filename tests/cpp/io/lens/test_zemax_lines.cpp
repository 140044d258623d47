// Lines of .zmx files that OpticStudio itself never or rarely writes.

#include <cmath>
#include <string>

#include "about.hpp"
#include "io/lens/lens_glass.hpp"
#include "io/lens_reading.hpp"
#include "optics/analysis/transmission.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

/// A plano-convex lens of radius 50 mm, whose focal length is 50 / (n - 1).
std::string singlet(const std::string& glass, const std::string& head = "") {
    return "MODE SEQ\nUNIT MM\n" + head +
           "ENPD 10\nWAVM 1 0.5875618 1\nPWAV 1\nFTYP 0 0 2 1 0 0 0\nYFLN 0 10\n"
           "SURF 0\n  CURV 0\n  DISZ INFINITY\n"
           "SURF 1\n  STOP\n  CURV 0.02\n  DISZ 4\n  GLAS " +
           glass +
           "\n  DIAM 8 1 0 0 1 \"\"\n"
           "SURF 2\n  CURV 0\n  DISZ 80\n  DIAM 8 1 0 0 1 \"\"\nSURF 3\n  CURV 0\n  DISZ 0\n";
}

/// A Cassegrain telescope of two perfect mirrors, with a disc in front of the secondary one.
std::string cassegrain(const std::string& disc) {
    return "MODE SEQ\nUNIT MM\nENPD 100\nFTYP 0 0 2 1 0 0 0\nYFLN 0 0.4\nWAVM 1 0.55 1\nPWAV 1\n"
           "SURF 0\n  CURV 0\n  DISZ INFINITY\nSURF 1\n  CURV 0\n  DISZ 150\n" +
           disc +
           "SURF 2\n  STOP\n  CURV -0.0025\n  CONI -1\n  DISZ -140\n  GLAS MIRROR 0 0 0 0\n  DIAM 50 1 0 0 1 \"\"\n"
           "  CLAP 15 50 0\n"
           "SURF 3\n  CURV -0.0055\n  CONI -3.3\n  DISZ 190\n  GLAS MIRROR 0 0 0 0\n  DIAM 18 1 0 0 1 \"\"\n"
           "SURF 4\n  CURV 0\n  DISZ 0\n";
}

}  // namespace

TEST_CASE("leading blanks mean nothing in a .zmx file") {
    const LensSystem lens = read(kZemax, "a.zmx").lens;
    std::string plain, tabs, deep;
    for (std::size_t i = 0; i < kZemax.size(); ++i) {
        const bool is_blank = kZemax[i] == ' ' && (i == 0 || kZemax[i - 1] == '\n' || kZemax[i + 1] == ' ' ||
                                                   (kZemax[i - 1] == ' ' && (i < 2 || kZemax[i - 2] == '\n')));
        if (!is_blank) plain += kZemax[i];
        deep += kZemax[i];
        if (kZemax[i] == '\n') deep += "    ";
        tabs += is_blank ? '\t' : kZemax[i];
    }
    CHECK(read(plain, "a.zmx").lens == lens);
    CHECK(read(tabs, "a.zmx").lens == lens);
    CHECK(read(deep, "a.zmx").lens == lens);
    for (const char* word : {"CURV 0.02", "GLAS N-BK7", "DISZ 5", "DIAM 8", "STOP"}) {
        CAPTURE(word);
        CHECK(read(replaced(kZemax, std::string("  ") + word, word), "a.zmx").lens == lens);
    }
    // The operands of the merit function, behind the surfaces, stay unnamed.
    CHECK_FALSE(read(kZemax + "MNUM 1 1\nBLNK\nXYZA 1 2\n", "a.zmx").warns_of("XYZA"));
}

TEST_CASE("an obscuration is a disc that blocks, and light passes everywhere beyond it") {
    // Two mirrors: f = f1 f2 / (f1 + f2 - d) in absolute values, and the disc takes its share of the pupil.
    const double focal = 200 * (1 / (2 * 0.0055)) / std::fabs(200 - 1 / (2 * 0.0055) - 140);
    for (const double disc : {16.0, 17.0, 18.0, 25.0})
        for (const char* diameter : {"  DIAM 18 1 0 0 1 \"\"\n", "", "  DIAM 1 1 0 0 1 \"\"\n"}) {
            CAPTURE(disc);
            const Reading reading =
                read(cassegrain(diameter + std::string("  OBSC 0 ") + std::to_string(disc) + " 0\n"), "a.zmx");
            REQUIRE(reading.error == "");
            CHECK(focal_length(reading.lens) == about(focal, 1e-12));
            const double expected = focal / 100 / std::sqrt(1 - disc * disc / 2500);
            // Shadows are bisected to 1e-9 of the area; those of the hyperbola's and the parabola's vertices are
            // planes.
            CHECK(t_stop(reading.lens, 550) == about(expected, 1e-6));
        }
    // Beyond a disc of the lens itself as well: its semi-diameter limits nothing then.
    const std::string on_glass = replaced(singlet("___BLANK 1 0 1.6 50"), "  DIAM 8", "  OBSC 0 2 0\n  DIAM 3");
    const Reading reading = read(on_glass, "a.zmx");
    REQUIRE(reading.error == "");
    CHECK(unobstructed_share(reading.lens, kLineD_nm) == about(1 - 4.0 / 25, 1e-6));
    // One on the plane of the stop is part of the stop.
    const std::string on_stop = replaced(replaced(kZemax, "  STOP\n", "  STOP\n  OBSC 0 1 0\n"), "ENPD 10", "ENPD 8");
    const LensSystem stopped = read(on_stop, "a.zmx").lens;
    CHECK(stopped.stop().inner_semi_diameter == 1);
    CHECK(read(cassegrain("  OBSC 0 300 0\n"), "a.zmx").says("a.zmx:11: surface 1: its obscuration blocks all light"));
}

TEST_CASE("a rim that is smaller than the stop's beam counts in the T-stop") {
    const std::string front =
        "MODE SEQ\nUNIT MM\nENPD 10\nWAVM 1 0.5875618 1\nPWAV 1\nFTYP 0 0 2 1 0 0 0\nYFLN 0 3\n"
        "SURF 0\n  CURV 0\n  DISZ INFINITY\nSURF 1\n  CURV 0\n  DISZ 5\n  CLAP 0 3 0\n"
        "SURF 2\n  STOP\n  CURV 0.02\n  DISZ 4\n  GLAS ___BLANK 1 0 1.6 50\n  DIAM 8\n"
        "SURF 3\n  CURV 0\n  DISZ 80\n  DIAM 8\nSURF 4\n  CURV 0\n  DISZ 0\n";
    const double bare = std::pow(1 - std::pow(0.6 / 2.6, 2), 2);  // two faces
    const double f_number = 50 / 0.6 / 6;  // of the beam that the rim leaves
    CHECK(t_stop(read(front, "a.zmx").lens, kLineD_nm) == about(f_number / std::sqrt(bare), 1e-9));
    // Behind the lens the axial ray of height h has descended to about h (1 - 9.5 * 0.6 / 50). First-order optics gives
    // the beam that a plane 10 mm behind the lens passes, up to third order in height over radius, 1e-2.
    const std::string rear = replaced(replaced(replaced(front, "  CLAP 0 3 0\n", ""), "  DISZ 80", "  DISZ 10"),
                                      "SURF 4\n  CURV 0\n  DISZ 0\n",
                                      "SURF 4\n  CURV 0\n  DISZ 70\n  CLAP 0 3 0\nSURF 5\n  CURV 0\n  DISZ 0\n");
    const LensSystem lens = read(rear, "a.zmx").lens;
    const double height = 1 - 4 * 0.6 * 0.02 / 1.6, slope = -0.6 * 0.02;  // behind the plane face, of h = 1
    const double at_rim = height + 10 * slope;
    CHECK(t_stop(lens, kLineD_nm) == about(50 / 0.6 * at_rim / 6 / std::sqrt(bare), 1e-2));
    CHECK(t_stop(lens, kLineD_nm) >
          1.3 * t_stop(read(replaced(front, "CLAP 0 3 0", "CLAP 0 9 0"), "a.zmx").lens, kLineD_nm));
    // A plane stop whose own aperture is smaller than its size by the entrance pupil.
    const std::string own =
        replaced(replaced(front, "  CLAP 0 3 0", "  STOP\n  CLAP 0 3 0"), "SURF 2\n  STOP", "SURF 2");
    CHECK(t_stop(read(own, "a.zmx").lens, kLineD_nm) == about(f_number / std::sqrt(bare), 1e-9));
}

TEST_CASE("a glass by its number, and a glass that is picked up") {
    const auto focal = [](const std::string& text) {
        const Reading reading = read(text, "a.zmx");
        CAPTURE(reading.error);
        REQUIRE(reading.error == "");
        return focal_length(reading.lens);
    };
    // The fields after the glass number are leftovers of another solve.
    CHECK(focal(singlet("517642 0 0 7734.3 17972.8 29.49 1 1 1 0 0")) == about(50 / 0.517, 1e-12));
    CHECK(focal(singlet("728284 0 0 1.5 40")) == about(50 / 0.728, 1e-12));
    CHECK(focal(singlet("517642 0 0 1.6 50", "GCAT SCHOTT\n")) == about(50 / 0.517, 1e-12));
    const Glass glass = read(singlet("517642 0 0"), "a.zmx").lens.surfaces.at(1).material;
    CHECK(io::abbe_pair(glass).v_d == about(64.2, 1e-9));

    const auto pair = [](const std::string& first, const std::string& second) {
        return replaced(singlet(first),
                        "SURF 2\n  CURV 0\n  DISZ 80\n  DIAM 8 1 0 0 1 \"\"\nSURF 3\n  CURV 0\n  DISZ 0\n",
                        "SURF 2\n  CURV 0\n  DISZ 1\n  DIAM 8\nSURF 3\n  CURV 0.02\n  DISZ 3\n  GLAS " + second +
                            "\n  DIAM 8\nSURF 4\n  CURV 0\n  DISZ 35\n  DIAM 8\nSURF 5\n  CURV 0\n  DISZ 0\n");
    };
    for (const auto& [first, second] : {std::pair("___BLANK 1 0 1.6 50", "___BLANK 2 1 1.6 50"),
                                        {"N-BK7 0 0 1.5 40", "N-BK7 2 1 1.5 40"},
                                        {"N-BK7 0 0 1.5 40", "___BLANK 2 1 1.5 40"},
                                        {"517642 0 0 1.5 40", "___BLANK 2 1 1.7 30"}}) {
        CAPTURE(first);
        const Reading reading = read(pair(first, second), "a.zmx");
        REQUIRE(reading.error == "");
        CHECK(reading.lens.surfaces.at(3).material == reading.lens.surfaces.at(1).material);
    }
    CHECK(read(pair("___BLANK 1 0 1.6 50", "___BLANK 2 4 1.6 50"), "a.zmx")
              .says("a.zmx:24: surface 3: picks up the glass of surface 4"));
    CHECK(read(pair("___BLANK 1 0 1.6 50", "___BLANK 2 2 1.6 50"), "a.zmx").says("surface 2, which has none"));
}

TEST_CASE("n_d and V_d that the file states of a glass that nobody lists are taken, where they are that glass's") {
    const Reading stated = read(singlet("XY-CROWN7 0 0 1.62 60.3 0"), "a.zmx");
    REQUIRE(stated.error == "");
    CHECK(focal_length(stated.lens) == about(50 / 0.62, 1e-12));
    CHECK(stated.warns_of("\"XY-CROWN7\" is in no catalogue"));
    for (const char* figures : {"1.5 40", "7734.3 17972.8", "1.62", "", "0 0", "1.62 0", "1.62 1000", "-1.62 60"}) {
        CAPTURE(figures);
        const Reading refused = read(singlet(std::string("XY-CROWN7 0 0 ") + figures), "a.zmx");
        CHECK(refused.says("surface 1: unknown glass \"XY-CROWN7\""));
        CHECK(refused.glass == "XY-CROWN7");
    }
    // The figures of a known glass show whether the file's figures are reliable: here they are leftovers.
    const std::string doublet =
        replaced(singlet("XY-CROWN7 0 0 1.62 60.3"), "SURF 2\n  CURV 0", "SURF 2\n  GLAS N-SF5 0 0 1.5 40\n  CURV 0");
    CHECK(read(doublet, "a.zmx").says("unknown glass \"XY-CROWN7\""));
    CHECK(read(replaced(doublet, "1.5 40", "1.67271 32.25"), "a.zmx").error == "");
}

TEST_CASE("the words for infinity, in any case") {
    for (const char* word : {"inf", "Inf", "INF", "infinity", "Infinity", "+inf"}) {
        CAPTURE(word);
        const Reading zemax = read(replaced(kZemax, "INFINITY", word), "a.zmx");
        CHECK(zemax.lens == read(kZemax, "a.zmx").lens);
        const Reading code_v = read(replaced(kCodeV, "SO 0.0 0.1e14", std::string("SO 0.0 ") + word), "a.seq");
        CHECK(code_v.lens == read(kCodeV, "a.seq").lens);
        const Reading plane = read(replaced(kCodeV, "S 0.0 3.0", std::string("S ") + word + " 3.0"), "a.seq");
        CHECK(plane.lens == read(kCodeV, "a.seq").lens);
        CHECK(read(replaced(kZemax, "DISZ 5", std::string("DISZ ") + word), "a.zmx").says("only the object"));
        CHECK(read(replaced(kCodeV, "S 50.0 5.0", std::string("S 50.0 ") + word), "a.seq").says("only the object"));
        CHECK(read(replaced(kZemax, "CURV 0.02", std::string("CURV ") + word), "a.zmx").says("finite"));
    }
}

TEST_CASE("messages about faces that cross name surfaces and lines of the file") {
    const std::string text =
        "MODE SEQ\nUNIT MM\nENPD 4\nFTYP 0 0 2 1 0 0 0\nYFLN 0 5\nWAVM 1 0.5875618 1\nPWAV 1\n"
        "SURF 0\n  CURV 0\n  DISZ INFINITY\nSURF 1\n  CURV 0\n  DISZ 5\n"  // line 11
        "SURF 2\n  CURV 0.005\n  DISZ 3\n  GLAS ___BLANK 1 0 1.5 60\n  DIAM 20\n"
        "SURF 3\n  CURV 0.04\n  DISZ 5\n  DIAM 18\n"  // line 19
        "SURF 4\n  CURV 0\n  DISZ 3\n  GLAS ___BLANK 1 0 1.5 60\n  DIAM 19\n"
        "SURF 5\n  CURV 0\n  DISZ 10\n  DIAM 15\n"
        "SURF 6\n  STOP\n  CURV 0\n  DISZ 5\n"
        "SURF 7\n  CURV 0.02\n  DISZ 3\n  GLAS ___BLANK 1 0 1.6 50\n  DIAM 10\n"
        "SURF 8\n  CURV 0\n  DISZ 50\n  DIAM 10\nSURF 9\n  CURV 0\n  DISZ 0\n";
    // No ray that passes reaches the crossing, 15 mm from the axis, before the aperture is wide enough.
    CHECK(read(text, "a.zmx").warns_of("surface 3 crosses surface 4"));
    const std::string wide =
        replaced(replaced(replaced(text, "ENPD 4", "ENPD 36"), "DIAM 10", "DIAM 25"), "DIAM 10", "DIAM 25");
    const Reading dummy = read(wide, "a.zmx");
    CHECK(dummy.says("a.zmx:19: surface 3: crosses surface 4, by"));
    CHECK(dummy.can_be_forced);
    io::LensReadOptions force;
    force.force = true;
    CHECK(read(wide, "a.zmx", force).warns_of("surface 3 crosses surface 4"));
    // A stop on a face becomes a plane of its own, which the file does not count.
    const std::string on_face =
        replaced(replaced(wide, "SURF 6\n  STOP\n", "SURF 6\n"), "SURF 2\n", "SURF 2\n  STOP\n");
    CHECK(read(on_face, "a.zmx").says("a.zmx:20: surface 3: crosses surface 4, by"));
    // A glass that has no index at the lens's wavelength, behind a dummy.
    const std::string glass = replaced(replaced(text, "0.5875618", "10.17"), "___BLANK 1 0 1.6 50", "N-BK7 0 0");
    CHECK(read(glass, "a.zmx").says("surface 7: its material \"N-BK7\" has no refractive index at 10170 nm"));
}

TEST_CASE("parameters of an extended asphere are read or named, never lost") {
    const std::string even = "  TYPE EVENASPH\n  PARM 2 1e-5\n  PARM 3 -2e-8\n",
                      extended = "  TYPE XASPHERE\n  XDAT 1 3\n  XDAT 2 1\n  XDAT 4 1e-5\n  XDAT 5 -2e-8\n";
    const auto with_type = [](const std::string& lines) {
        return read(replaced(singlet("N-BK7 0 0 1.5168 64.17"), "SURF 1\n", "SURF 1\n" + lines), "a.zmx");
    };
    const LensSystem asphere = with_type(even).lens;
    CHECK(asphere.surfaces.at(1).is_asphere());
    CHECK(with_type(extended).lens == asphere);
    CHECK_FALSE(with_type(extended).warns_of("XASPHERE"));
    // OpticStudio's manual numbers the extra data as parameters from 13 on.
    CHECK(with_type("  TYPE XASPHERE\n  PARM 13 3\n  PARM 14 1\n  PARM 16 1e-5\n  PARM 17 -2e-8\n").lens == asphere);
    // The manual defines no parameters 1 to 12 for these types. Files converted from tables have coefficients there.
    const Reading converted = with_type(replaced(even, "EVENASPH", "XASPHERE"));
    CHECK(converted.lens == asphere);
    CHECK(
        converted.warns_of("surface 1 of type XASPHERE has no extended terms; its parameters are read as those of "
                           "type EVENASPH"));
    const Reading odd = with_type("  TYPE XOSPHERE\n  PARM 4 1e-5\n");
    CHECK(odd.lens == with_type("  TYPE ODDASPHE\n  PARM 4 1e-5\n").lens);
    CHECK(odd.warns_of("as those of type ODDASPHE"));
    // Beside extended terms they cannot be meant, and neither can they in types without any.
    const Reading both = with_type(extended + "  PARM 2 1e-3\n");
    CHECK(both.lens == asphere);
    CHECK(both.warns_of("surface 1 has parameters (PARM) that its type XASPHERE lacks: they are left out"));
    CHECK(with_type("  TYPE XPOLYNOM\n  PARM 1 1\n").warns_of("its type XPOLYNOM lacks"));
    CHECK(with_type("  TYPE BICONICX\n  PARM 1 50\n  PARM 3 1\n").warns_of("its type BICONICX lacks"));
    CHECK_FALSE(with_type("  TYPE BICONICX\n  PARM 1 50\n  PARM 3 0\n").warns_of("BICONICX"));
}
