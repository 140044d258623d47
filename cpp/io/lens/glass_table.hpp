#pragma once
#include "../../optics/prescription/glass.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Reads a glass from its table: exactly one of n_d with V_d, sellmeier, cauchy, table, index.
Glass glass_from_table(const TomlTable& table);

}  // namespace realcam::io
