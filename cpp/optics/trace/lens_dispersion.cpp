#include "lens_dispersion.hpp"

namespace realcam {

WavelengthVariable variable_over(WavelengthRange range) {
    const auto pole = static_cast<double>(WavelengthVariable::kPole_nm);
    // Values of 1 / (wavelength - pole), which is mapped linearly to [-1, 1], at the ends of the range.
    const double low = 1 / (range.last - pole), high = 1 / (range.first - pole);
    if (!(high - low > 1e-9)) return {0, 0};
    return {static_cast<float>(2 / (high - low)), static_cast<float>(-(high + low) / (high - low))};
}

std::vector<int> non_dispersive_surfaces(const LensSystem& lens) {
    std::vector<int> found;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& surface = lens.surfaces[i];
        if (surface.type == SurfaceType::refracting && !surface.material.is_air() && surface.material.has_one_index())
            found.push_back(static_cast<int>(i) + 1);
    }
    return found;
}

void check_dispersion(const LensSystem& lens, WavelengthRange range) {
    check_glasses_known(lens, range, "dispersion");
    const Glass* last = nullptr;
    for (const Surface& surface : lens.surfaces)
        if (surface.type == SurfaceType::refracting) last = &surface.material;
    if (last && !last->has_one_index())
        throw InputError("dispersion: the film of " + lens.name +
                         " lies in glass; expected a lens with air behind its last surface");
}

std::vector<IndexCubic> index_cubics(const LensSystem& lens, const std::vector<Crossing>& crossings,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable) {
    return cubics_over(
        lens, crossings, wavelengths_nm, variable, [](const Crossing& crossing, const std::vector<double>& indices) {
            const double before = crossing.index_before(indices), behind = crossing.index_behind(indices);
                           // Unlike n'^2 / n^2 - 1, this does not cancel for nearly equal indices.
            return (behind - before) * (behind + before) / (before * before);
        });
}

std::vector<IndexCubic> index_cubics(const LensSystem& lens, LightDirection direction,
                                     const std::vector<double>& wavelengths_nm, WavelengthVariable variable) {
    const std::vector<Crossing> to_film = crossings_of(lens);
    return index_cubics(lens, direction == LightDirection::to_film ? to_film : reversed(to_film), wavelengths_nm,
                        variable);
}

}  // namespace realcam
