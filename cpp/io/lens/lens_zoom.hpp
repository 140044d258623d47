#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../optics/prescription/lens_system.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Tables [[zoom]] of a lens file and its key "zoom_position". Every error is a LensFileError with file and line.
class LensZoom {
public:
    /// Reads the tables of a lens file. `file`: its top-level table.
    explicit LensZoom(const TomlTable& file);

    /// True if zooming changes the thickness behind a surface, numbered from 1, so that its table may omit it.
    bool changes(int surface) const;

    /// Sets the lens's zoom positions, and thicknesses that its tables omit to those of the current position.
    /// `has_thickness`: for each surface, true if its table has a thickness. Film distances that the file omits are
    /// those of the smallest axial spot. Throws Cancelled if `keep_going` returns false.
    void apply(LensSystem& lens, const std::vector<bool>& has_thickness, const KeepGoing& keep_going) const;

private:
    /// Table [[zoom]].
    struct Position {
        TomlTable table;
        std::string name;
        std::vector<std::pair<int, double>> thicknesses;  ///< by surface from 1, ascending
    };
    /// Throws LensFileError unless all positions have thicknesses of the same surfaces.
    void check_same_surfaces() const;

    TomlTable file_;
    std::vector<Position> positions_;
    std::optional<int> current_;  ///< index of the key "zoom_position"; std::nullopt without the key
};

}  // namespace realcam::io
