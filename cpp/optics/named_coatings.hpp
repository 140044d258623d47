#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coating.hpp"
#include "metals.hpp"

namespace REALCAM_NAMESPACE {

/// Magnesium fluoride, of which most single layers are, as a film (H. A. Macleod, Thin-Film Optical Filters), at the
/// wavelength to which eye and film are most sensitive.
inline constexpr double kQuarterWaveIndex = 1.38, kQuarterWaveDesign_nm = 550;

/// Coatings that have a name of their own in lens files and in Python.
inline const std::vector<std::string>& named_coatings() {
    static const std::vector<std::string> names{"unknown", "bare", "quarter_wave", "aluminium", "silver"};
    return names;
}

/// Nothing where no coating has that name.
inline std::optional<Coating> named_coating(std::string_view name) {
    if (name == "unknown") return Coating();
    if (name == "bare") return bare_surface();
    if (name == "quarter_wave") {
        CoatingMaterial film = CoatingMaterial::transparent(Glass::constant(kQuarterWaveIndex));
        film.label = "MgF2";
        return quarter_wave_coating(film, kQuarterWaveDesign_nm);
    }
    if (name == "aluminium") return metal_mirror(aluminium(), {}, "aluminium");
    if (name == "silver") return metal_mirror(silver(), {}, "silver");
    return std::nullopt;
}

/// Nothing where no metal has that name.
inline std::optional<CoatingMaterial> named_metal(std::string_view name) {
    if (name == "aluminium") return aluminium();
    if (name == "silver") return silver();
    return std::nullopt;
}

}  // namespace REALCAM_NAMESPACE
