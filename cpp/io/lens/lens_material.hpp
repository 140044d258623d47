#pragma once
#include <optional>
#include <string>

#include "../../optics/prescription/coating_material.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// Returns a number as text, without trailing zeros.
std::string number_label(double value);

/// Reads a glass from its table: exactly one of n_d with V_d, sellmeier, cauchy, table, index.
Glass glass_from_table(const TomlTable& table);

/// Reads the key "material", which must exist: an index, [n_d, V_d], or the name of a glass of the file or of the
/// catalogue. `glasses`: the file's table "glass".
Glass read_material(const TomlTable& table, const std::optional<TomlTable>& glasses);

/// Reads complex refractive indices n + ik under a key: [n, k], or [[wavelength in nm, n, k], ...] by increasing
/// wavelength.
CoatingMaterial read_complex_index(const TomlTable& table, std::string_view key);

}  // namespace realcam::io
