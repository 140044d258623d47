#pragma once
#include <map>
#include <optional>
#include <string>

#include "../../optics/prescription/lens_system.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Coatings of a lens file: its tables [coating.NAME], the predefined coatings, and the default for all faces. Every
/// error is a LensFileError with file and line.
class LensCoatings {
public:
    /// `glasses`: the file's table "glass", whose glasses may be used for layers.
    LensCoatings(const TomlTable& file, const std::optional<TomlTable>& glasses);

    /// Returns the coating that the key "coating" of a surface's table names; without the key, an unknown coating.
    Coating coating_of(const TomlTable& surface) const;

    /// Applies the file's "default_coating" to faces between air and glass without a key "coating".
    void apply_default(LensSystem& lens, const toml::array& surfaces) const;

private:
    /// Returns the coating that the text under `key` names.
    Coating named(const TomlTable& table, std::string_view key) const;

    std::map<std::string, Coating> file_coatings_;  ///< the tables [coating.NAME], by name
    Coating default_;                               ///< "default_coating"; unknown without it
};

}  // namespace realcam::io
