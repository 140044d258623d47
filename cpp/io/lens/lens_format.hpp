#pragma once
#include <string>
#include <string_view>

#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// A format of another program's lens files.
struct LensFormat {
    std::string_view suffix;  ///< ".zmx"
    Prescription (*read)(std::string_view text, const std::string& file, LensGlasses& glasses,
                         const LensReadOptions& options);
    LensText (*write)(const LensSystem& lens);  ///< null: it is only read
};

/// By the suffix of a file's name, in any case. Null: realcam's own, TOML.
const LensFormat* foreign_format_of(const std::string& path);

/// The suffixes that are read, or those that are written, in a sentence: ".toml, .zmx or .seq".
std::string lens_suffixes(bool written);

/// "after" or "before". Throws InputError.
PbrtThickness pbrt_thickness_named(const std::string& name);

}  // namespace realcam::io
