#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coating.hpp"

namespace REALCAM_NAMESPACE {

/// Refractive index of a film of magnesium fluoride, the usual single-layer coating (H. A. Macleod, Thin-Film Optical
/// Filters), and the design wavelength, to which eye and film are most sensitive.
inline constexpr double kQuarterWaveIndex = 1.38, kQuarterWaveDesign_nm = 550;

/// Names of the predefined coatings in lens files and in Python.
const std::vector<std::string>& named_coatings();

/// Returns std::nullopt if no coating has that name.
std::optional<Coating> named_coating(std::string_view name);

/// Returns std::nullopt if no metal has that name.
std::optional<CoatingMaterial> named_metal(std::string_view name);

}  // namespace REALCAM_NAMESPACE
