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
    explicit LensZoom(const TomlTable& file);

    /// True if zooming changes the thickness behind a surface, numbered from 1, so that its table may omit it.
    bool changes(int surface) const;

    /// Sets the lens's zoom positions, and thicknesses that its tables omit to those of the current position. `given`:
    /// for each surface, true if its table has a thickness. Film distances that are not given are those of the smallest
    /// axial spot. Throws Cancelled if `keep_going` returns false.
    void apply(LensSystem& lens, const std::vector<bool>& given, const KeepGoing& keep_going) const;

private:
    struct Position {
        TomlTable table;
        std::string name;
        std::vector<std::pair<int, double>> thicknesses;  ///< by surface from 1, ascending
    };
    void check_same_surfaces() const;

    TomlTable file_;
    std::vector<Position> positions_;
    std::optional<int> current_;  ///< if stated in the file
};

}  // namespace realcam::io
