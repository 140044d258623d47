#pragma once
// Parts of the reader and the writer of realcam's own lens files, which are TOML.

#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>

#include "../../checkpoint.hpp"
#include "../../optics/prescription/lens_system.hpp"
#include "../text/toml_table.hpp"
#include "lens_format.hpp"

namespace realcam::io {

/// Reads a lens from the table of a lens file. `file`: its name in messages. Throws LensFileError.
LensSystem lens_from_table(const toml::table& table, const std::string& file, const KeepGoing& keep_going);

/// Returns the text of a lens file, which preserves the lens exactly.
std::string lens_as_toml(const LensSystem& lens);

/// Reads the form of a surface from its table. Throws LensFileError.
SurfaceForm read_form(const TomlTable& table);

/// Reads the shape of a surface's aperture from its table. `rim`: clear semi-diameter, to which the arms of a spider
/// extend. Throws LensFileError.
ApertureShape read_aperture(const TomlTable& table, double rim);

/// Return the lines of a surface's table from which read_form and read_aperture restore the form and the aperture
/// shape; empty for the default.
std::string form_as_toml(const SurfaceForm& form);
std::string aperture_as_toml(const ApertureShape& shape);

/// Formats a number as a TOML float, with ".0" if needed: TOML reads a number without a point as a 64-bit integer.
inline std::string toml_number(double value) {
    const std::string text = exact_number(value);
    return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

/// Returns the double that `convert` maps exactly to `value`, among `estimate` and its two neighbours; std::nullopt if
/// none of them does. Used to write a value in a customary unit without loss.
template <class Convert>
std::optional<double> exact_preimage(double estimate, double value, const Convert& convert) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {estimate, std::nextafter(estimate, kInfinity), std::nextafter(estimate, -kInfinity)})
        if (std::isfinite(candidate) && convert(candidate) == value) return candidate;
    return std::nullopt;
}

}  // namespace realcam::io
