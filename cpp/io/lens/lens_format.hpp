#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Lens file format of another program.
struct LensFormat {
    std::string_view suffix;  ///< ".zmx"
    Prescription (*read)(std::string_view text, const std::string& file, LensGlasses& glasses,
                         const LensReadOptions& options);
    LensText (*write)(const LensSystem& lens);  ///< null if the format is only read
};

/// Returns the format by the suffix of a file's name, ignoring case. Null for realcam's own format, TOML.
const LensFormat* foreign_format_of(const std::string& path);

/// Returns the suffixes that are read, or those that are written, for a sentence: ".toml, .zmx or .seq".
std::string lens_suffixes(bool written);

/// Parses "after" or "before". Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
