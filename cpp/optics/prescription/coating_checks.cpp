#include "coating_checks.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

namespace {

/// Throws InputError if a refractive index or wavelength is invalid. `what` names the material in the message.
void check_material(const CoatingMaterial& material, const std::string& what) {
    for (std::size_t i = 0; i < material.points.size(); ++i) {
        const CoatingMaterial::Point& p = material.points[i];
        if (!(p.n > 0 && p.n <= 100) || !(p.k >= 0 && p.k <= 1000))
            throw InputError("the refractive index n + ik of " + what +
                             " needs n above 0, at most 100, and k from 0 (k > 0 absorbs) to 1000");
        if (!(p.wavelength_nm > 0) || !std::isfinite(p.wavelength_nm))
            throw InputError("the wavelengths of " + what + " must be positive numbers, in nm");
        if (i > 0 && !(p.wavelength_nm > material.points[i - 1].wavelength_nm))
            throw InputError("the wavelengths of " + what + " must be strictly increasing");
    }
    if (!material.points.empty()) return;
    const auto [first, last] = material.glass.known_nm();
    const double n = material.glass.index(std::clamp(kLineD_nm, first, last));
    if (!(n >= 1 && n <= 10))
        throw InputError("the refractive index of " + what + " must lie between 1 and 10" +
                         (std::isnan(n) ? "" : "; it is " + std::to_string(n)));
}

/// Throws InputError if the thickness or the material of a layer is invalid. `what` names the layer in the message.
void check_layer(const CoatingLayer& layer, const std::string& what) {
    check_material(layer.material, what);
    if (!(layer.thickness_nm >= 0 && layer.thickness_nm <= kMaxLayerThickness_nm))
        throw InputError("the thickness of " + what + " must lie between 0 and 1e6 nm");
}

}  // namespace

void validate(const CoatingLayer& layer) {
    check_layer(layer, "layer 1");
}

void validate(const Coating& coating) {
    if (coating.layers.size() > kMaxCoatingLayers)
        throw InputError("the coating has " + std::to_string(coating.layers.size()) + " layers; at most " +
                         std::to_string(kMaxCoatingLayers) + " are supported");
    for (std::size_t i = 0; i < coating.layers.size(); ++i)
        check_layer(coating.layers[i], "layer " + std::to_string(i + 1));
    const bool has_layers = coating.kind == CoatingKind::layers || coating.kind == CoatingKind::metal;
    if (!has_layers && !coating.layers.empty()) throw InputError("this kind of coating cannot have layers");
    check_material(coating.metal, "the metal");
    if (!(coating.reflectance >= 0 && coating.reflectance <= 1))
        throw InputError("the reflectance of a mirror must lie between 0 and 1");
}

void check_coating_fits(const Surface& surface) {
    if (surface.coating.kind == CoatingKind::unknown) return;
    if (!surface.bends_light()) throw InputError("a stop or an aperture cannot be coated");
    const bool mirror = surface.type == SurfaceType::mirror;
    if (mirror && !surface.coating.is_for_mirrors())
        throw InputError("the coating of a mirror must be a metal, with or without layers, or a reflectance");
    if (!mirror && surface.coating.is_for_mirrors())
        throw InputError("only a mirror can have a metal or a reflectance as its coating; this surface is refracting");
}

}  // namespace realcam
