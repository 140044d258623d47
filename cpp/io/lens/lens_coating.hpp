#pragma once
#include <map>
#include <optional>
#include <string>

#include "../../optics/prescription/lens_system.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// The coatings of a lens file: its tables [coating.NAME], those that have a name of their own, and what it says of all
/// faces at once. Every complaint is a LensFileError with file and line.
class LensCoatings {
public:
    /// `glasses`: the file's table "glass", of which layers may be made too.
    LensCoatings(const TomlTable& file, const std::optional<TomlTable>& glasses);

    /// The key "coating" of a surface; unknown where there is none.
    Coating of(const TomlTable& surface) const;

    /// Gives faces between air and glass that have no key "coating" the file's "default_coating".
    void apply_default(LensSystem& lens, const toml::array& surfaces) const;

private:
    Coating named(const TomlTable& table, std::string_view key) const;

    std::map<std::string, Coating> own_;
    Coating default_;
};

}  // namespace realcam::io
