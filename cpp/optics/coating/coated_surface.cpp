#include "coated_surface.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace realcam {

CoatedSurface::CoatedSurface(const Coating& coating, bool is_mirror, double wavelength_nm, double before, double behind,
                             bool as_listed)
    : stack_{wavelength_nm, before, {}, behind},
      is_mirror_(is_mirror),
      has_stated_reflectance_(is_mirror && coating.kind != CoatingKind::metal),
      stated_reflectance_(coating.kind == CoatingKind::reflectance ? coating.reflectance : 1) {
    for (const CoatingLayer& layer : coating.layers)
        stack_.films.push_back({known_index(layer.material, wavelength_nm), layer.thickness_nm});
    if (!as_listed) std::reverse(stack_.films.begin(), stack_.films.end());
    if (coating.kind == CoatingKind::metal) stack_.index_behind = known_index(coating.metal, wavelength_nm);
}

PolarisedResponse CoatedSurface::at(double cosine) const {
    if (!has_stated_reflectance_) return response_of(stack_, cosine);
    // Phases of a perfect conductor, which reverses the tangential electric field.
    const double r = std::sqrt(stated_reflectance_);
    return {{-r, 0, stated_reflectance_, 0, 1 - stated_reflectance_},
            {r, 0, stated_reflectance_, 0, 1 - stated_reflectance_}};
}

std::complex<double> CoatedSurface::known_index(const CoatingMaterial& material, double wavelength_nm) {
    const WavelengthRange range = between_resonances(material.glass);
    if (wavelength_nm > range.first && wavelength_nm < range.last) return material.index(wavelength_nm);
    throw InputError("the coating material" + (material.name().empty() ? "" : " \"" + material.name() + '"') +
                     " lets no light pass at " + std::to_string(std::lround(wavelength_nm)) +
                     " nm, at or beyond a resonance");
}

namespace {

/// True if light travelling to the film crosses the layers of a surface in the order of their list, which starts at the
/// medium of lower index (air).
bool layers_listed_towards_film(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return medium_before(lens, index).index(kLineD_nm) <= surface.material.index(kLineD_nm);
}

}  // namespace

CoatedSurface coated_surface(const LensSystem& lens, std::size_t index, double wavelength_nm, LightDirection direction,
                             const std::vector<double>& indices) {
    const Surface& surface = lens.surfaces[index];
    const bool to_film = direction == LightDirection::to_film, is_mirror = surface.type == SurfaceType::mirror;
    try {
        return {surface.coating,
                is_mirror,
                wavelength_nm,
                to_film ? indices[index] : indices[index + 1],
                to_film ? indices[index + 1] : indices[index],
                is_mirror || to_film == layers_listed_towards_film(lens, index)};
    } catch (const InputError& error) {
        throw InputError("surface " + std::to_string(index + 1) + " of lens \"" + lens.name + "\": " + error.what());
    }
}

std::vector<std::optional<CoatedSurface>> coated_surfaces(const LensSystem& lens, double wavelength_nm,
                                                          LightDirection direction) {
    const std::vector<double> indices = lens.indices(wavelength_nm);
    std::vector<std::optional<CoatedSurface>> surfaces;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        surfaces.emplace_back();
        if (lens.surfaces[i].bends_light())
            surfaces.back() = coated_surface(lens, i, wavelength_nm, direction, indices);
    }
    if (direction == LightDirection::to_scene) std::reverse(surfaces.begin(), surfaces.end());
    return surfaces;
}

const Glass& medium_before(const LensSystem& lens, std::size_t index) {
    static const Glass air = Glass::air();
    for (std::size_t i = index; i-- > 0;)
        if (lens.surfaces[i].type == SurfaceType::refracting) return lens.surfaces[i].material;
    return air;
}

bool is_face_in_air(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.type == SurfaceType::refracting && medium_before(lens, index).is_air() != surface.material.is_air();
}

namespace {

/// True if the surface is a mirror or a face in air whose coating the lens does not specify.
bool has_unknown_coating(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.coating.kind == CoatingKind::unknown &&
           (surface.type == SurfaceType::mirror || is_face_in_air(lens, index));
}

}  // namespace

std::vector<int> surfaces_with_unknown_coating(const LensSystem& lens) {
    std::vector<int> found;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (has_unknown_coating(lens, i)) found.push_back(static_cast<int>(i));
    return found;
}

std::string coating_summary(const LensSystem& lens) {
    std::vector<std::pair<std::string, std::string>> groups;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& surface = lens.surfaces[i];
        const bool is_mirror = surface.type == SurfaceType::mirror;
        const bool unknown = surface.coating.kind == CoatingKind::unknown;
        if (!surface.bends_light() || (unknown && !has_unknown_coating(lens, i))) continue;
        const std::string name = unknown ? std::string("unknown, taken as ") + (is_mirror ? "a perfect mirror" : "bare")
                                 : surface.coating.name.empty() ? "unnamed"
                                                                : surface.coating.name;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& other) { return other.first == name; });
        if (group == groups.end()) group = groups.insert(group, {name, ""});
        group->second += (group->second.empty() ? "" : ", ") + std::to_string(i + 1);
    }
    std::string text;
    for (const auto& [name, numbers] : groups) text += (text.empty() ? "" : "; ") + name + ": " + numbers;
    return text;
}

}  // namespace realcam
