#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace realcam::io {

/// Returns the names of the bundled lenses, sorted.
std::vector<std::string> lens_names();

/// Returns the lens files in the folders of the environment variable REALCAM_LENS_PATH, separated by colons, by file
/// name without suffix. Bundled lenses take precedence, and then earlier folders.
std::map<std::string, std::string> lens_files_on_path();

/// Returns the text of a bundled lens file. Throws LensFileError, with the nearest names, if there is no such lens.
std::string_view bundled_lens_text(const std::string& name);

/// Meaning of the thickness in a row of a pbrt lens table: the distance after the row's surface, or before it;
/// by_first_row: detected from the first row.
enum class PbrtThickness { by_first_row, after, before };

/// Fields and wavelengths that a lens was designed for, as stated in another program's file.
struct DesignLight {
    std::vector<double> fields_deg;  ///< field angles of the chief rays, by first-order optics; empty if not stated
    std::vector<double> wavelengths_nm;
};

/// Options for reading another program's lens file.
struct LensReadOptions {
    /// Glasses for names in the file that are unknown or ambiguous, by name in the file.
    std::map<std::string, Glass> glasses;
    /// Glasses of the user's catalogues (see read_glass_catalogue), which take precedence over the bundled ones.
    std::map<std::string, Glass> catalogue;
    /// Omits features that realcam does not model, with a warning; otherwise the file is rejected.
    bool force = false;
    PbrtThickness pbrt_thickness = PbrtThickness::by_first_row;
    /// Called with a line of text for everything omitted or assumed; may be empty.
    std::function<void(const std::string&)> warn;
    /// Called while reading; long files take seconds. If it returns false, reading ends with Cancelled.
    KeepGoing keep_going;
    DesignLight* design_light = nullptr;  ///< receives the design light, if not null
};

/// True if `name` denotes a file rather than a lens of a known name: it is not that of a bundled lens, and it has a '/'
/// or the suffix of a lens file, or a file exists at `path`. `path`: the name itself, or relative to another file's
/// folder.
bool is_lens_path(const std::string& name, const std::string& path);

/// Reads a lens: a bundled one or one of the lens path by name, or a file by its path (see is_lens_path). The suffix
/// selects the format: .zmx (Zemax), .seq (CODE V), .len (OSLO), .dat (pbrt), .json (Optiland) or .roa (ray-optics),
/// ignoring case; any other is a lens file of realcam, TOML. The lens is wide open and focused at infinity, unless its
/// file states otherwise. Throws LensFileError, naming file, line and surface, and InputError if the options name a
/// glass that the file does not have.
LensSystem read_lens(const std::string& name_or_path, const LensReadOptions& options = {});

/// Reads a lens from the text of a lens file of realcam (format 1, described in lenses/README.md). `file`: its name in
/// messages.
LensSystem parse_lens(std::string_view text, const std::string& file, const KeepGoing& keep_going = {});

/// Reads a lens from the bytes of a lens file, whose format follows from its name.
LensSystem parse_lens_file(std::string_view bytes, const std::string& file, const LensReadOptions& options = {});

/// Returns a glass of the catalogue: "N-BK7", or "schott:F4" if makers share a name. Throws InputError if the name is
/// unknown (with the nearest names) or ambiguous.
Glass catalogue_glass(const std::string& name);

/// Adds the glasses of a Zemax glass catalogue (.agf) to `catalogue`, by bare_glass_name. Throws LensFileError naming
/// file and line.
void read_glass_catalogue(const std::string& path, std::map<std::string, Glass>& catalogue);

/// Parses a glass specified on the command line, "NAME=n_d,V_d" or "NAME=schott:F4". Returns the name and the glass.
/// Throws InputError.
std::pair<std::string, Glass> named_glass(const std::string& text);

/// Text of a lens file; `warnings` names the properties of the lens that its format cannot express.
struct LensText {
    std::string text;
    std::vector<std::string> warnings;
};

/// Returns the text of a lens file in the format of the suffix: .zmx, .seq, .json, .roa, or TOML, which preserves the
/// lens exactly. Throws InputError if the lens has a text that no file can contain, or if the suffix is not that of a
/// format for writing.
LensText lens_text_for(const LensSystem& lens, const std::string& path);

}  // namespace realcam::io
