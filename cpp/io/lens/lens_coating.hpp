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

    /// Reads the key "coating" of a surface; without it, the coating is unknown.
    Coating of(const TomlTable& surface) const;

    /// Applies the file's "default_coating" to faces between air and glass without a key "coating".
    void apply_default(LensSystem& lens, const toml::array& surfaces) const;

private:
    Coating named(const TomlTable& table, std::string_view key) const;

    std::map<std::string, Coating> own_;
    Coating default_;
};

}  // namespace realcam::io
