#pragma once
#include <optional>
#include <string>

#include "../../optics/prescription/coating_material.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Formats a number with at most six decimals, without trailing zeros.
std::string number_label(double value);

/// Reads a glass from its table, which must have exactly one of: n_d with V_d, sellmeier, cauchy, table, index. Throws
/// LensFileError.
Glass glass_from_table(const TomlTable& table);

/// Reads the key "material", which must exist: an index, [n_d, V_d], or the name of a glass of the file or of the
/// catalogue. `glasses`: the file's table "glass". Throws LensFileError.
Glass read_material(const TomlTable& table, const std::optional<TomlTable>& glasses);

/// Reads complex refractive indices n + ik under a key: [n, k], or [[wavelength in nm, n, k], ...] by increasing
/// wavelength. The key must exist. Throws LensFileError.
CoatingMaterial read_complex_index(const TomlTable& table, std::string_view key);

}  // namespace realcam::io
