#include "coating.hpp"

#include "coating_material.hpp"

namespace realcam {

const std::vector<std::string>& named_coatings() {
    static const std::vector<std::string> names{"unknown", "bare", "quarter_wave", "aluminium", "silver"};
    return names;
}

std::optional<Coating> named_coating(std::string_view name) {
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

std::optional<CoatingMaterial> named_metal(std::string_view name) {
    if (name == "aluminium") return aluminium();
    if (name == "silver") return silver();
    return std::nullopt;
}

}  // namespace realcam
