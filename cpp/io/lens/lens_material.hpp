#pragma once
#include <optional>
#include <string>

#include "../../optics/prescription/coating_material.hpp"
#include "../text/toml_table.hpp"

namespace realcam::io {

/// A number without zeros at its end.
std::string number_label(double value);

/// The key "material", which must be there: an index, [n_d, V_d], the name of a glass of the file or of the catalogue.
/// `glasses`: the file's table "glass".
Glass read_material(const TomlTable& table, const std::optional<TomlTable>& glasses);

/// Refractive indices n + ik under a key: [n, k], or [[wavelength in nm, n, k], ...] by rising wavelength.
CoatingMaterial read_complex_index(const TomlTable& table, std::string_view key);

}  // namespace realcam::io
