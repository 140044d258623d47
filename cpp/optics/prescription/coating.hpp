#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coating_material.hpp"

namespace REALCAM_NAMESPACE {

/// One homogeneous thin film.
struct CoatingLayer {
    CoatingMaterial material;
    double thickness_nm = 0;  ///< physical, along the normal

    bool operator==(const CoatingLayer&) const = default;
};

enum class CoatingKind {
    unknown,  ///< unspecified: code that needs a reflectance has to assume a coating, and to report that it does
    bare,  ///< uncoated
    layers,  ///< thin films between the two media of a refracting surface
    metal,  ///< mirror: an opaque metal, with or without films on it
    reflectance,  ///< mirror with a stated reflectance, equal at all angles and wavelengths
};

/// Coating of a surface. Scaling the lens does not scale the films' thicknesses.
struct Coating {
    CoatingKind kind = CoatingKind::unknown;
    std::string name;  ///< name given by its author; may be empty
    /// Layers from the air inwards. The first film touches the medium of the lower index at the d line (if both are
    /// equal, the one on the scene's side); the last touches the glass, or a mirror's metal. One coating therefore fits
    /// both faces of an element. The first film of a mirror touches the medium that the light comes through.
    std::vector<CoatingLayer> layers;
    CoatingMaterial metal;  ///< for the kind `metal`
    double reflectance = 1;  ///< for the kind `reflectance`: reflected fraction of the power, 0 to 1

    bool operator==(const Coating&) const = default;

    /// True if the coating suits mirrors only.
    bool is_for_mirrors() const { return kind == CoatingKind::metal || kind == CoatingKind::reflectance; }
};

/// Returns the coating of an uncoated surface.
inline Coating bare_surface() {
    return {CoatingKind::bare, "bare", {}, {}, 1};
}

/// Returns a coating of thin films in the order of Coating::layers; bare if there are none.
inline Coating layered_coating(std::vector<CoatingLayer> layers, std::string name = {}) {
    return {layers.empty() ? CoatingKind::bare : CoatingKind::layers, std::move(name), std::move(layers), {}, 1};
}

/// Returns the coating of a mirror by an opaque metal with these films on it.
inline Coating metal_mirror(CoatingMaterial metal, std::vector<CoatingLayer> layers = {}, std::string name = {}) {
    return {CoatingKind::metal, std::move(name), std::move(layers), std::move(metal), 1};
}

/// Returns the coating of a mirror with this reflectance, 0 to 1, at all angles and wavelengths.
inline Coating stated_reflectance(double reflectance, std::string name = {}) {
    return {CoatingKind::reflectance, std::move(name), {}, {}, reflectance};
}

/// Returns the physical thickness of a film, nm, whose optical thickness at normal incidence is `waves` design
/// wavelengths (0.25: a quarter-wave film).
inline double thickness_of_waves(const CoatingMaterial& material, double waves, double design_wavelength_nm) {
    return waves * design_wavelength_nm / material.index(design_wavelength_nm).real();
}

/// Returns the usual single-layer antireflection coating: a quarter wave thick at the design wavelength.
inline Coating quarter_wave_coating(const CoatingMaterial& material, double design_wavelength_nm) {
    return layered_coating({{material, thickness_of_waves(material, 0.25, design_wavelength_nm)}}, "quarter_wave");
}

/// Refractive index of a film of magnesium fluoride, the usual single-layer coating (H. A. Macleod, Thin-Film Optical
/// Filters), and its design wavelength, to which eye and film are most sensitive.
inline constexpr double kQuarterWaveIndex = 1.38, kQuarterWaveDesign_nm = 550;

/// Returns the names of the predefined coatings in lens files and in Python.
const std::vector<std::string>& named_coatings();

/// Returns the predefined coating of this name; std::nullopt if there is none.
std::optional<Coating> named_coating(std::string_view name);

/// Returns the metal of this name, "aluminium" or "silver"; std::nullopt for any other name.
std::optional<CoatingMaterial> named_metal(std::string_view name);

}  // namespace REALCAM_NAMESPACE
