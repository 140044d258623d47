#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "../../keep_going.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace realcam::io {

/// Names of the bundled lenses, sorted.
std::vector<std::string> lens_names();

/// Lens files in the folders of the environment variable REALCAM_LENS_PATH, separated by colons, by name: the file's
/// without its suffix. A bundled lens, and the first of the folders, come before others of the same name.
std::map<std::string, std::string> lens_files_on_path();

/// The text of a bundled lens file. Throws LensFileError, with the nearest names, where there is none.
std::string_view bundled_lens_text(const std::string& name);

/// The row of a pbrt lens table in which a thickness stands: that of the surface behind it, or in front of it.
enum class PbrtThickness { by_first_row, after, before };

/// The light that a lens was designed for, as another program's file states it.
struct DesignLight {
    std::vector<double> fields_deg;  ///< of the chief rays, by first-order optics; empty: the file states none
    std::vector<double> wavelengths_nm;
};

/// What a reader may be told of another program's file.
struct LensReadOptions {
    /// Glasses by the names that the file gives them: for those that no catalogue has, or several.
    std::map<std::string, Glass> glasses;
    /// Glasses of the user's catalogues (see read_glass_catalogue), which come before the bundled ones.
    std::map<std::string, Glass> catalogue;
    /// Leaves out what realcam has no model of, with a warning, where else the file is refused.
    bool force = false;
    PbrtThickness pbrt_thickness = PbrtThickness::by_first_row;
    /// Is called with a line of text for all that was left out or assumed. Empty: nobody listens.
    std::function<void(const std::string&)> warn;
    /// Long files take seconds; where it returns false, reading ends by throwing Cancelled.
    KeepGoing keep_going;
    DesignLight* design_light = nullptr;  ///< receives it
};

/// Whether `name` means a file. It does if it is no bundled lens, and has a '/' or the suffix of a lens file, or if a
/// file exists at `path`. This is the name itself, or the name relative to another file's folder.
bool is_lens_path(const std::string& name, const std::string& path);

/// Reads a lens: a bundled one or one of the lens path by name, or a file by its path (see is_lens_path). The suffix
/// says how to read it: .zmx (Zemax), .seq (CODE V), .len (OSLO), .dat (pbrt), .json (Optiland) or .roa (ray-optics),
/// in any case; anything else is a lens file of realcam, TOML. The lens is focused at infinity, or as its file says,
/// and wide open. Throws LensFileError, naming file, line and surface, and InputError where the options name a glass
/// that the file does not have.
LensSystem read_lens(const std::string& name_or_path, const LensReadOptions& options = {});

/// Reads a lens from the text of a lens file of realcam (format 1, described in lenses/README.md).
/// `file` is what messages call it.
LensSystem parse_lens(std::string_view text, const std::string& file, const KeepGoing& keep_going = {});

/// Reads a lens from the bytes of any lens file, whose name says how.
LensSystem parse_lens_file(std::string_view bytes, const std::string& file, const LensReadOptions& options = {});

/// A glass of the catalogue: "N-BK7", or "schott:F4" where makers share a name.
/// Throws InputError where the name is unknown (with the nearest names) or stands for several glasses.
Glass catalogue_glass(const std::string& name);

/// Adds the glasses of a catalogue of Zemax (.agf), by bare name. Throws InputError naming file and line.
void read_glass_catalogue(const std::string& path, std::map<std::string, Glass>& catalogue);

/// A glass as the command line names it, "NAME=n_d,V_d" or "NAME=schott:F4": the name, and the glass. Throws
/// InputError.
std::pair<std::string, Glass> named_glass(const std::string& text);

/// What a file of another program cannot say of a lens is in `warnings`.
struct LensText {
    std::string text;
    std::vector<std::string> warnings;
};

/// The text of a lens file by the suffix of its name: .zmx, .seq, or else TOML, which gives the same lens again.
/// Throws InputError where the lens has a text that no file can hold, or the suffix is that of a format that is only
/// read.
LensText lens_text_for(const LensSystem& lens, const std::string& path);

}  // namespace realcam::io
