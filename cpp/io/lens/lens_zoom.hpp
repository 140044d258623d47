#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../keep_going.hpp"
#include "../../optics/prescription/lens_system.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// The tables [[zoom]] of a lens file and its key "zoom_position". Every complaint is a LensFileError with file and
/// line.
class LensZoom {
public:
    explicit LensZoom(const TomlTable& file);

    /// Whether zooming changes the thickness behind a surface, from 1: its table may leave it out.
    bool changes(int surface) const;

    /// Sets the lens's zoom positions, and what its tables leave out to the current one. `given`: for each surface
    /// whether its table has a thickness. Film distances that are not given are those of the smallest axial spot.
    /// Throws Cancelled where `keep_going` returns false.
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
    std::optional<int> current_;  ///< where the file says it
};

}  // namespace realcam::io
