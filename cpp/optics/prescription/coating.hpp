#pragma once
#include <string>
#include <utility>
#include <vector>

#include "coating_material.hpp"

namespace REALCAM_NAMESPACE {

/// One homogeneous film.
struct CoatingLayer {
    CoatingMaterial material;
    double thickness_nm = 0;  ///< physical, along the normal

    bool operator==(const CoatingLayer&) const = default;
};

enum class CoatingKind {
    unknown,      ///< not said: whoever asks for numbers has to assume something, and to say so
    bare,         ///< nothing between the two media
    layers,       ///< films between the two media of a refracting surface
    metal,        ///< a mirror: a metal too thick for light to pass, with or without films on it
    reflectance,  ///< a mirror that reflects a stated share of the light at every angle and wavelength
};

/// What covers a surface: a value. Films keep their thickness, whatever the size of the lens.
struct Coating {
    CoatingKind kind = CoatingKind::unknown;
    std::string name;  ///< as its author calls it; may be empty
    /// Layers from the air inwards. The first film touches the medium of the lower index at the d line (of two equal
    /// ones, the one on the scene's side). The last touches the glass, or a mirror's metal. So one coating fits both
    /// faces of an element. The first film of a mirror touches the medium that the light comes through.
    std::vector<CoatingLayer> layers;
    CoatingMaterial metal;  ///< of the kind `metal`
    double reflectance = 1;  ///< of the kind `reflectance`, a share of the power

    bool operator==(const Coating&) const = default;

    bool is_for_mirrors() const { return kind == CoatingKind::metal || kind == CoatingKind::reflectance; }
};

inline Coating bare_surface() {
    return {CoatingKind::bare, "bare", {}, {}, 1};
}

inline Coating layered_coating(std::vector<CoatingLayer> layers, std::string name = {}) {
    return {layers.empty() ? CoatingKind::bare : CoatingKind::layers, std::move(name), std::move(layers), {}, 1};
}

inline Coating metal_mirror(CoatingMaterial metal, std::vector<CoatingLayer> layers = {}, std::string name = {}) {
    return {CoatingKind::metal, std::move(name), std::move(layers), std::move(metal), 1};
}

inline Coating stated_reflectance(double reflectance, std::string name = {}) {
    return {CoatingKind::reflectance, std::move(name), {}, {}, reflectance};
}

/// Physical thickness of a film whose optical thickness, at normal incidence, is so many waves. A quarter is 0.25.
inline double thickness_of_waves(const CoatingMaterial& material, double waves, double design_wavelength_nm) {
    return waves * design_wavelength_nm / material.index(design_wavelength_nm).real();
}

/// The usual single layer against reflections: a quarter of a wave thick at one wavelength.
inline Coating quarter_wave_coating(const CoatingMaterial& material, double design_wavelength_nm) {
    return layered_coating({{material, thickness_of_waves(material, 0.25, design_wavelength_nm)}}, "quarter_wave");
}

}  // namespace REALCAM_NAMESPACE
