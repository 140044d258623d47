#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coating.hpp"

namespace REALCAM_NAMESPACE {

/// Magnesium fluoride, of which most single layers are, as a film (H. A. Macleod, Thin-Film Optical Filters), at the
/// wavelength to which eye and film are most sensitive.
inline constexpr double kQuarterWaveIndex = 1.38, kQuarterWaveDesign_nm = 550;

/// Coatings that have a name of their own in lens files and in Python.
const std::vector<std::string>& named_coatings();

/// Nothing where no coating has that name.
std::optional<Coating> named_coating(std::string_view name);

/// Nothing where no metal has that name.
std::optional<CoatingMaterial> named_metal(std::string_view name);

}  // namespace REALCAM_NAMESPACE
