// OSLO's .len files against first-order optics.

#include <cmath>
#include <string>

#include "about.hpp"
#include "io/lens_reading.hpp"
#include "optics/lens/focus.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

/// With its wavelengths behind END, where some programs write them.
const std::string kOslo =
    "// OSLO 7.0\n"
    "LEN NEW \"singlet\" 100 3\n"  // line 2
    "EBR 5\n"
    "ANG 10\n"
    "DES \"O'Neill\"\n"
    "UNI 1.0\n"
    "// SRF 0\n"
    "AIR\n"
    "TH 1e20\n"
    "NXT  // SRF 1\n"  // line 10
    "GLA BK7\n"
    "RD 51.68\n"
    "TH 3\n"
    "AST\n"
    "AP 6\n"
    "NXT\n"
    "AIR\n"
    "RD 1e20\n"
    "TH 98\n"
    "AP 6\n"
    "NXT\n"
    "AIR\n"
    "END 3\n"
    "WV .58756 .48613 .65627\n";

std::string with(const std::string& from, const std::string& to) {
    return replaced(kOslo, from, to);
}

LensSystem oslo_lens(const std::string& text) {
    const Reading reading = read(text, "a.len");
    CAPTURE(reading.error);
    REQUIRE(reading.error == "");
    return reading.lens;
}

constexpr double kBk7 = 1.5168;  // at 587.56 nm, to the data sheet's digits

}  // namespace

TEST_CASE("an OSLO file is the lens") {
    const LensSystem lens = oslo_lens(kOslo);
    CHECK(lens.title == "singlet");
    CHECK(focal_length(lens) == about(51.68 / (kBk7 - 1), 1e-5));
    CHECK(first_order(lens, lens.wavelength_nm).entrance_pupil_diameter == about(10, 1e-12));
    CHECK(lens.film_distance == 98);
    CHECK(lens.surfaces.at(1).clear_semi_diameter == 6);
    CHECK(lens.wavelength_nm == about(587.56, 1e-12));
    // Its fields go to 10 degrees: h = f tan 10 deg, less 2 mm of defocus and a per cent of distortion.
    CHECK(std::hypot(lens.film_width, lens.film_height) / 2 == about(17.6, 0.04));
    // Commands share lines, in any case.
    CHECK(oslo_lens(with("RD 51.68\nTH 3\n", "rd 51.68; Th 3 ; cc 0 // th 4\n")) == lens);
    CHECK(oslo_lens(with("RD 51.68", "CV 0.019349845201238391")).surfaces.at(1).curvature == about(1 / 51.68, 1e-15));
    CHECK(oslo_lens(with("AST\n", "")) == lens);  // surface 1 is the stop where none is stated
    CHECK(oslo_lens(with("1e20\nNXT", "inf\nNXT")) == lens);
    CHECK(oslo_lens(with("END 3\nWV .58756 .48613 .65627\n", "WV .58756 .48613 .65627\nEND 3\nOPE NEW\nWV 9\n")) ==
          lens);
    CHECK(focal_length(oslo_lens(with("UNI 1.0", "UNI 25.4"))) == about(25.4 * focal_length(lens), 1e-12));
    CHECK(oslo_lens(with("END 3\n", "GTO 2\nTH 97\nEND 3\n")).film_distance == 97);
}

TEST_CASE("apertures and objects of an OSLO file") {
    const auto pupil = [](const LensSystem& lens) {
        return first_order(lens, lens.wavelength_nm).entrance_pupil_diameter;
    };
    const double focal = focal_length(oslo_lens(kOslo));
    CHECK(pupil(oslo_lens(with("EBR 5", "FNO 8"))) == about(focal / 8, 1e-12));
    CHECK(pupil(oslo_lens(with("EBR 5", "NAP 0.05"))) == about(2 * focal * std::tan(std::asin(0.05)), 1e-12));
    const std::string near = replaced(with("1e20\nNXT", "500\nNXT"), "TH 98", "TH 123");
    CHECK(pupil(oslo_lens(near)) == about(10, 1e-12));  // the stop is at the first surface
    CHECK(oslo_lens(near).focus_distance == about(500 + 3 + 123, 1e-12));
    CHECK(pupil(oslo_lens(replaced(near, "EBR 5", "NAO 0.01"))) == about(2 * 500 * std::tan(std::asin(0.01)), 1e-12));
}

TEST_CASE("glasses, mirrors and aspheres of an OSLO file") {
    const auto index = [](const LensSystem& lens, double nm) { return lens.surfaces.at(1).material.index(nm); };
    CHECK(index(oslo_lens(with("GLA BK7", "GLA 1.6")), 450) == 1.6);
    const LensSystem sampled = oslo_lens(with("GLA BK7", "GLA 1.6 1.61 1.59"));
    CHECK(index(sampled, 486.13) == about(1.61, 1e-12));
    CHECK(index(sampled, 656.27) == about(1.59, 1e-12));
    CHECK(index(oslo_lens(with("GLA BK7", "GLA MOD 1.7 30")), kLineD_nm) == about(1.7, 1e-12));
    CHECK(index(oslo_lens(with("GLA BK7", "GLA 517642")), kLineD_nm) == about(1.517, 1e-12));
    // F4 is 1.616592 at Schott and 1.620047 at CDGM.
    const Reading shared = read(with("GLA BK7", "GLA F4"), "a.len");
    CHECK(index(shared.lens, kLineD_nm) == about(1.616592, 1e-6));
    CHECK(shared.warns_of("assumed to be Schott's"));
    const Reading named = read(with("GLA BK7", "GLA F4"), "a.len", with_glass("F4=cdgm:F4"));
    CHECK(index(named.lens, kLineD_nm) == about(1.620047, 1e-6));
    const Reading unknown = read(with("GLA BK7", "GLA XBK77"), "a.len");
    CHECK(unknown.says("a.len:11: surface 1: unknown glass \"XBK77\""));
    CHECK(read(with("GLA BK7", "GLA 1.6 1.61"), "a.len").says("has 2 indices for 3 wavelengths"));

    const LensSystem asphere = oslo_lens(with("TH 3\n", "TH 3\nCC -0.5\nAD 1e-5\nAE 2e-8\nAF 3e-11\nAG 4e-14\n"));
    const Surface& s = asphere.surfaces.at(1);
    CHECK(s.conic == -0.5);
    CHECK(s.aspheric == std::vector<double>{1e-5, 2e-8, 3e-11, 4e-14});
    const LensSystem general = oslo_lens(with("TH 3\n", "TH 3\nASP ASR 3\nAS2 1e-5\nAS3 2e-8\n"));
    CHECK(general.surfaces.at(1).aspheric == std::vector<double>{1e-5, 2e-8});
    const LensSystem inch = oslo_lens(replaced(with("TH 3\n", "TH 3\nAD 1e-3\n"), "UNI 1.0", "UNI 25.4"));
    CHECK(inch.surfaces.at(1).aspheric.at(0) == about(1e-3 / std::pow(25.4, 3), 1e-12));

    // Two mirrors, as in a Cassegrain telescope.
    const LensSystem mirrors = oslo_lens(
        "LEN NEW \"c\" 1 3\nEBR 50\nANG 0.4\nUNI 1\nTH 1e20\nNXT\nRFL\nRD -400\nTH -140\nAST\nAP 50\nNXT\n"
        "RFL\nRD -181.81818181818181\nTH 190\nAP 17\nNXT\nWV 0.55\nEND 3\n");
    const double f1 = 200, f2 = 181.81818181818181 / 2;
    CHECK(std::fabs(focal_length(mirrors)) == about(f1 * f2 / std::fabs(f1 - f2 - 140), 1e-12));
}

TEST_CASE("pickups and solves of an OSLO file") {
    // A symmetric pair: the second lens has the first one's curvatures with the other sign, its thickness and glass.
    const std::string pair =
        "LEN NEW \"pair\" 100 6\nEBR 4\nANG 5\nUNI 1\nTH 1e20\nNXT\n"
        "GLA BK7\nRD 60\nTH 4\nAP 6\nNXT\nRD 300\nTH 5\nAP 6\nNXT\nAST\nPK TH 2\nNXT\n"
        "PK GLA 1\nPK CVM 2\nPK TH 1\nPK AP 1\nNXT\nPK CVM -4\nAP 6\nPY 0\nNXT\nWV .58756\nEND 6\n";
    const LensSystem lens = oslo_lens(pair);
    REQUIRE(lens.surfaces.size() == 5);
    CHECK(lens.surfaces[3].curvature == about(-1.0 / 300, 1e-15));
    CHECK(lens.surfaces[4].curvature == about(-1.0 / 60, 1e-15));
    CHECK(lens.surfaces[3].thickness == 4);
    CHECK(lens.surfaces[2].thickness == 5);
    CHECK(lens.surfaces[3].material == lens.surfaces[0].material);
    // The solve puts the image where the axial ray comes to the axis.
    CHECK(lens.film_distance == about(first_order(lens, lens.wavelength_nm).back_focal_distance, 1e-12));
    // A slope of the axial ray behind the last face: that of f/N with N = f / 8.
    const std::string solved = replaced(pair, "PK CVM -4\nAP 6\n", "PU -0.08\nAP 6\n");
    CHECK(focal_length(oslo_lens(solved)) == about(4 / 0.08, 1e-12));
    CHECK(read(replaced(pair, "PK TH 1\n", "PK TH 5\n"), "a.len").says("PK TH picks up from surface 5"));
    CHECK(read(replaced(pair, "PK TH 1\n", "PK LN 1 2\n"), "a.len").says("a pickup of LN (PK)"));
    CHECK(read(replaced(pair, "PY 0", "PYC 0"), "a.len").says("a solve of the chief ray (PYC)"));
}

TEST_CASE("what an OSLO file lacks, or realcam has no model of, is told") {
    for (const char* line :
         {"TLA 5", "DCY 1", "GC 0", "BEN", "CVX 0.1", "PFL 50", "GSP 0.01", "APN 1", "ASP ZER 4", "LMO NSS"}) {
        CAPTURE(line);
        const Reading reading = read(with("TH 3\n", std::string("TH 3\n") + line + "\n"), "a.len");
        CHECK(reading.says("a.len:14: surface 1: has "));
        CHECK(reading.can_be_forced);
    }
    CHECK(oslo_lens(with("TH 3\n", "TH 3\nTLA 0\nDCY 0.0\n")) == oslo_lens(kOslo));
    CHECK(read(with("TH 3\n", "TH 3\nQQQ 1\n"), "a.len").warns_of("QQQ"));
    CHECK(read(with("END 3", "END 4"), "a.len").says("a.len:23: the image is surface 3; the file says that it is 4"));
    CHECK(read(with("100 3", "100 4"), "a.len").says("the image is surface 3"));
    CHECK(read(with("RD 51.68", "RD x"), "a.len").says("a.len:12: surface 1: the radius must be a finite number"));
    CHECK(read("AIR\n", "a.len").says("begins no lens"));
    const LensSystem lens = oslo_lens(kOslo);
    for (std::size_t n = 0; n < kOslo.find("WV"); ++n) {
        const Reading reading = read(kOslo.substr(0, n), "a.len");
        CHECK((reading.error != "" || reading.lens == lens));
        CHECK(reading.error.find('\n') == std::string::npos);
    }
}

TEST_CASE("an OSLO aperture may be left unstated, and is not negative") {
    CHECK(read(with("AP 6\nNXT\nAIR\nRD", "AP 0\nNXT\nAIR\nRD"), "a.len").error == "");
    CHECK(read(with("AP 6\nNXT\nAIR\nRD", "AP -3\nNXT\nAIR\nRD"), "a.len")
              .says("the radius of the aperture is -3; expected 0 (not stated) or more"));
}
