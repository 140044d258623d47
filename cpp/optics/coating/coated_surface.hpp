#pragma once
#include <optional>
#include <vector>

#include "../prescription/glass_resonances.hpp"
#include "../prescription/lens_system.hpp"
#include "../trace/lens_path.hpp"
#include "thin_film.hpp"

namespace REALCAM_NAMESPACE {

/// A coating between two media, or on a mirror, met by light of one wavelength from one side. An unknown coating is
/// taken for none on glass and for a perfect mirror's on a mirror: whoever shows numbers of it has to say so.
class CoatedSurface {
public:
    /// `before`, `behind`: refractive indices of the media in the light's order, of a mirror both the same.
    /// `as_listed`: whether the light meets the layers in the order of the list. Throws InputError where a layer's
    /// index is not known at that wavelength.
    CoatedSurface(const Coating& coating, bool is_mirror, double wavelength_nm, double before, double behind,
                  bool as_listed);

    /// `cosine`: of the angle of incidence, in the medium from which the light comes.
    PolarisedResponse at(double cosine) const;

    bool is_mirror() const { return is_mirror_; }

private:
    static std::complex<double> known_index(const CoatingMaterial& material, double wavelength_nm);

    FilmStack stack_;
    bool is_mirror_, has_stated_reflectance_;
    double stated_;
};

/// One surface of a lens for light of one wavelength on its way to the film or to the scene. `indices`: of
/// lens.indices(wavelength_nm). Throws InputError, with surface and material, where a layer's index is not known.
CoatedSurface coated_surface(const LensSystem& lens, std::size_t index, double wavelength_nm, LightDirection direction,
                             const std::vector<double>& indices);

/// All surfaces in the order in which the light meets them; none for stops and apertures, at which light is blocked or
/// passes as it is. Throws InputError where an index is not known.
std::vector<std::optional<CoatedSurface>> coated_surfaces(const LensSystem& lens, double wavelength_nm,
                                                          LightDirection direction);

}  // namespace REALCAM_NAMESPACE
