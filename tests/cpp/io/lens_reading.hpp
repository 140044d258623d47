#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "io/lens/lens_error.hpp"
#include "io/lens/lens_file.hpp"
#include "optics/lens/paraxial.hpp"
#include "optics/prescription/lens_checks.hpp"

namespace realcam::test {

/// Result of reading the text of a lens file.
struct Reading {
    std::string error;  ///< empty if the text was read
    bool can_be_forced = false;
    std::string glass;  ///< name of the unknown glass
    LensSystem lens;
    std::vector<std::string> warnings;

    bool warns_of(const std::string& words) const {
        return std::any_of(warnings.begin(), warnings.end(),
                           [&](const std::string& w) { return w.find(words) != std::string::npos; });
    }
    bool says(const std::string& words) const { return error.find(words) != std::string::npos; }
};

inline Reading read(const std::string& text, const std::string& file, io::LensReadOptions options = {}) {
    Reading reading;
    options.warn = [&](const std::string& message) { reading.warnings.push_back(message); };
    try {
        reading.lens = io::parse_lens_file(text, file, options);
        validate(reading.lens);
    } catch (const LensFileError& error) {
        reading.error = error.what();
        if (const auto* read_error = dynamic_cast<const io::LensReadError*>(&error)) {
            reading.can_be_forced = read_error->can_be_forced;
            reading.glass = read_error->glass;
        }
    } catch (const InputError& error) {
        reading.error = error.what();
    }
    return reading;
}

inline io::LensReadOptions with_glass(const std::string& text, bool force = false) {
    io::LensReadOptions options;
    const auto [name, glass] = io::named_glass(text);
    options.glasses.emplace(name, glass);
    options.force = force;
    return options;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// A singlet, a dummy on either side of it, and a stop behind. No TYPE lines, as in old files.
inline const std::string kZemax =
    "VERS 1\n"
    "MODE SEQ\n"
    "NAME Probe\n"
    "UNIT MM X W X CM MR CPMM\n"
    "ENPD 10\n"
    "GCAT SCHOTT\n"
    "FTYP 0 0 2 3 0 0 0\n"
    "XFLN 0 0 0\n"
    "YFLN 0 5 0\n"
    "WAVM 1 0.4861 1\n"
    "WAVM 2 0.5876 1\n"
    "WAVM 3 0.6563 1\n"
    "PWAV 2\n"
    "SURF 0\n"
    "  CURV 0 0 0\n"
    "  DISZ INFINITY\n"
    "SURF 1\n"  // line 17
    "  CURV 0 0 0\n"
    "  DISZ 3\n"
    "SURF 2\n"  // line 20
    "  CURV 0.02 0 0\n"
    "  DISZ 5\n"
    "  GLAS N-BK7 0 0 1.5 40 0 0\n"  // line 23
    "  DIAM 8 0 0 0 1 \"\"\n"
    "SURF 3\n"
    "  CURV -0.01 0 0\n"
    "  DISZ 6\n"
    "  DIAM 8 0 0 0 1 \"\"\n"
    "SURF 4\n"
    "  CURV 0 0 0\n"
    "  DISZ -2\n"
    "SURF 5\n"
    "  STOP\n"
    "  CURV 0 0 0\n"
    "  DISZ 60\n"
    "SURF 6\n"
    "  CURV 0 0 0\n"
    "  DISZ 0\n";

inline const std::string kCodeV =
    "RDM;LEN \"VERSION: 1\"\n"
    "TITLE 'Probe'\n"
    "EPD 10.0\n"
    "DIM M\n"
    "WL 656.3 587.6 486.1\n"
    "REF 2\n"
    "YAN 0.0 5.0\n"
    "SO 0.0 0.1e14\n"
    "S 0.0 3.0\n"
    "S 50.0 5.0 NBK7_SCHOTT ! crown\n"  // line 10
    "  CIR 8.0\n"
    "S -100.0 6.0; CIR 8.0\n"
    "S 0.0 -2.0\n"
    "S 0.0 60.0\n"
    "  STO\n"
    "SI 0.0 0.0\n"
    "GO\n";

inline double focal_length(const LensSystem& lens) {
    return first_order(lens, lens.wavelength_nm).effective_focal_length;
}

}  // namespace realcam::test
