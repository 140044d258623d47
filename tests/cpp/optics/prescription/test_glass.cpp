// Refractive indices against makers' data sheets, and the interpolation between given ones.

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "about.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_glass.hpp"
#include "io/lens/lens_text.hpp"
#include "refusal.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

std::string glass_complaint(const std::string& name) {
    return message_of([&] { io::catalogue_glass(name); });
}

}  // namespace

TEST_CASE("N-BK7 has the indices of its data sheet at every line") {
    // Schott, optical glass data sheets, N-BK7 517642.251; five decimals.
    struct Line {
        double wavelength_nm, index;
    };
    for (const char* name : {"N-BK7", "schott:N-BK7"}) {
        const Glass glass = io::catalogue_glass(name);
        for (const Line& line : {Line{706.5188, 1.51289}, Line{656.2725, 1.51432}, Line{643.8469, 1.51472},
                                 Line{587.5618, 1.51680}, Line{546.0740, 1.51872}, Line{486.1327, 1.52238},
                                 Line{479.9914, 1.52283}, Line{435.8343, 1.52668}, Line{404.6561, 1.53024}}) {
            CAPTURE(line.wavelength_nm);
            CHECK(std::fabs(glass.index(line.wavelength_nm) - line.index) <= 0.5e-5);
        }
        const double abbe = (glass.index(kLineD_nm) - 1) / (glass.index(kLineF_nm) - glass.index(kLineC_nm));
        CHECK(std::fabs(abbe - 64.17) <= 0.5e-2);
    }
}

TEST_CASE("fused silica has the indices of Malitson's table") {
    // J. Opt. Soc. Am. 55, 1205 (1965), table I: computed, to the fifth decimal; and what SILICA is to other programs.
    struct Line {
        double wavelength_nm, index;
    };
    for (const char* name : {"SILICA", "misc:F_SILICA"}) {
        const Glass glass = io::catalogue_glass(name);
        for (const Line& line : {Line{404.6561, 1.46962}, Line{435.8343, 1.46669}, Line{546.0740, 1.46008},
                                 Line{587.5618, 1.45846}, Line{656.2725, 1.45637}}) {
            CAPTURE(line.wavelength_nm);
            CHECK(std::fabs(glass.index(line.wavelength_nm) - line.index) <= 0.5e-5);
        }
    }
}

TEST_CASE("moulding glasses, crystals and plastics have the indices that are published of them") {
    // The makers' six-digit codes: n_d - 1 to three digits, V_d to three.
    struct Code {
        const char* name;
        int code;
    };
    for (const Code& glass :
         {Code{"L-BSL7", 516641}, Code{"L-BAL35", 589612}, Code{"L-BAL42", 583594}, Code{"L-TIM28", 689310},
          Code{"L-LAM60", 743493}, Code{"L-LAL13", 694532}, Code{"L-LAH53", 806409}, Code{"ohara:FPL53", 439949},
          Code{"ohara:PBH6", 805254}, Code{"hikari:E-LAFH3", 795287}, Code{"hikari:J-BK7", 517639}}) {
        CAPTURE(glass.name);
        const io::AbbePair pair = io::abbe_pair(io::catalogue_glass(glass.name));
        CHECK(std::fabs(pair.n_d - 1 - 1e-3 * (glass.code / 1000)) <= 0.51e-3);
        CHECK(std::fabs(pair.v_d - 0.1 * (glass.code % 1000)) <= 0.051);
    }
    struct Pair {
        const char* name;
        double n_d, v_d, n_tolerance, v_tolerance;
    };
    // Crystals to the digits of the tables in the papers that the catalogue cites: CaF2 1.43384 and V 95, MgF2 1.37774
    // and 106.2, sapphire 1.76817 and 72.2. Plastics to the spread of what is stated of them, 1e-3 and 2.
    for (const Pair& p :
         {Pair{"CAF2", 1.43384, 95.0, 2e-5, 0.2}, Pair{"MGF2", 1.37774, 106.2, 2e-5, 0.2},
          Pair{"SAPPHIRE", 1.76817, 72.2, 2e-5, 0.2}, Pair{"LIF", 1.3921, 97.3, 1e-4, 0.6},
          Pair{"ZNSE", 2.61, 8.1, 1e-2, 0.3}, Pair{"ZNS", 2.368, 15.4, 2e-3, 0.3}, Pair{"PMMA", 1.491, 57.4, 1e-3, 2},
          Pair{"POLYCARB", 1.585, 29.9, 1e-3, 2}, Pair{"POLYSTYR", 1.591, 30.9, 1e-3, 2},
          Pair{"E48R", 1.531, 56, 1e-3, 2}, Pair{"COC", 1.533, 56.2, 1e-3, 2}, Pair{"SAN", 1.567, 34.8, 1e-3, 2}}) {
        CAPTURE(p.name);
        const io::AbbePair pair = io::abbe_pair(io::catalogue_glass(p.name));
        CHECK(std::fabs(pair.n_d - p.n_d) <= p.n_tolerance);
        CHECK(std::fabs(pair.v_d - p.v_d) <= p.v_tolerance);
    }
}

TEST_CASE("a name that several makers use must say which; each has its own index") {
    CHECK(io::catalogue_glass("schott:F4").index(kLineD_nm) == about(1.616592, 0.5e-6));
    // CDGM's is a fit of its power series, within 5e-6 as the catalogue states.
    CHECK(std::fabs(io::catalogue_glass("cdgm:F4").index(kLineD_nm) - 1.620047) < 5.5e-6);
    const std::string message = glass_complaint("F4");
    CAPTURE(message);
    CHECK(contains(message, "several catalogues"));
    CHECK(contains(message, "\"schott:F4\""));
    CHECK(contains(message, "\"cdgm:F4\""));
    CHECK(contains(glass_complaint("N-BK8"), "did you mean"));
    CHECK(contains(glass_complaint("N-BK8"), "\"N-BK7\""));
    CHECK(contains(glass_complaint("zeiss:N-BK7"), "unknown glass \"zeiss:N-BK7\""));
    CHECK(contains(glass_complaint(""), "unknown glass"));
    CHECK(contains(glass_complaint(":"), "unknown glass"));
}

TEST_CASE("every glass of the catalogue is a glass, with normal dispersion over the visible") {
    std::istringstream text{std::string(io::bundled_glass_catalogue())};
    std::string line, maker;
    int glasses = 0;
    while (std::getline(text, line)) {
        if (!line.empty() && line[0] == '[') maker = line.substr(1, line.find(']') - 1);
        if (line.empty() || line[0] != '"') continue;
        const std::string name = maker + ':' + line.substr(1, line.find('"', 1) - 1);
        CAPTURE(name);
        const Glass glass = io::catalogue_glass(name);
        ++glasses;
        double before = 10;
        bool falling = true;
        // Connolly measured zinc selenide from 540 nm on; its first pole lies at 391 nm.
        const double shortest = name == "misc:ZNSE-CONNOLLY" ? 540 : 380;
        for (double wavelength = shortest; wavelength <= 780; wavelength += 20) {
            const double n = glass.index(wavelength);
            falling = falling && n < before && n > 1.3 && n < (maker == "misc" ? 4 : 2.4);  // false for NaN too
            before = n;
        }
        CHECK(falling);
    }
    CHECK(glasses > 500);
}

TEST_CASE("a glass by index and Abbe number has both") {
    for (const double n_d : {1.4, 1.5168, 1.84666})
        for (const double abbe : {20.0, 64.17, 95.0}) {
            const Glass glass = Glass::from_abbe_number(n_d, abbe);
            const double spread = glass.index(kLineF_nm) - glass.index(kLineC_nm);
            CHECK(glass.index(kLineD_nm) == about(n_d, 1e-15));
            CHECK((n_d - 1) / spread == about(abbe, 1e-12));  // spread cancels three digits
        }
}

TEST_CASE("formulas give what they say") {
    CHECK(Glass::constant(1.7).index(450) == 1.7);
    CHECK(Glass::air().is_air());
    // n = A + B / l^2 + C / l^4 at l = 0.5 um.
    CHECK(Glass::cauchy({1.5, 0.004, 0.0001}).index(500) == about(1.5 + 0.016 + 0.0016, 1e-15));
    // n^2 = 1 + B l^2 / (l^2 - C).
    CHECK(Glass::sellmeier({{1.25, 0.05}}).index(500) == about(std::sqrt(1 + 1.25 * 0.25 / 0.2), 1e-15));
    CHECK(std::isnan(Glass::sellmeier({{1.25, 0.3}}).index(500)));  // below its resonance: no real index
}

TEST_CASE("a table of indices is met at its points, and by a cubic in 1/l^2 between them") {
    const auto cubic = [](double nm) {
        const double x = 1e6 / (nm * nm);
        return 1.5 + 0.004 * x + 2e-4 * x * x - 1e-5 * x * x * x;
    };
    std::vector<Glass::TablePoint> points;
    for (const double nm : {656.0, 400.0, 780.0, 486.0, 588.0, 365.0, 436.0})
        points.push_back({nm, cubic(nm)});  // unsorted
    const Glass glass = Glass::table(points);
    for (double nm = 340; nm <= 850; nm += 7) {
        CAPTURE(nm);
        // Rounding, of Lagrange weights up to a few tens outside the points.
        CHECK(std::fabs(glass.index(nm) - cubic(nm)) < 1e-13);
    }
    for (const Glass::TablePoint& p : points) CHECK(glass.index(p.wavelength_nm) == about(p.index, 1e-15));

    // With fewer points, the polynomial through all of them.
    CHECK(Glass::table({{500, 1.6}}).index(700) == 1.6);
    const Glass line = Glass::table({{500, 1.6}, {1000, 1.57}});  // x = 4 and 1
    CHECK(line.index(1e3 / std::sqrt(2.5)) == about(1.585, 1e-14));
}

TEST_CASE("a table stays close to the glass that it was made from") {
    const Glass glass = io::catalogue_glass("schott:SF6");
    std::vector<Glass::TablePoint> points;
    for (const double nm : {365.0, 405.0, 436.0, 486.0, 546.0, 588.0, 656.0, 707.0, 852.0})
        points.push_back({nm, glass.index(nm)});
    const Glass table = Glass::table(points);
    // A cubic's error between the lines of a data sheet, for the most dispersive of the common glasses.
    for (double nm = 380; nm <= 780; nm += 5) CHECK(std::fabs(table.index(nm) - glass.index(nm)) < 2e-5);
}
