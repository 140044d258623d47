#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "../prescription/glass_resonances.hpp"
#include "../prescription/lens_system.hpp"
#include "../trace/lens_path.hpp"
#include "thin_film.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the medium in front of surface `index` (from 0), on the scene's side.
const Glass& medium_before(const LensSystem& lens, std::size_t index);

/// True if a refracting surface has air on exactly one side; lens makers coat these faces. Two glasses in contact are
/// cemented, and uncoated unless the lens specifies a coating.
bool is_face_in_air(const LensSystem& lens, std::size_t index);

/// Returns the surfaces, counted from 0, whose coating the lens does not specify: glass faces in air, assumed to be
/// bare, and mirrors, assumed to be perfect.
std::vector<int> surfaces_with_unknown_coating(const LensSystem& lens);

/// Lists the coatings of all faces in air, all mirrors and all other surfaces with a specified coating, with surface
/// numbers from 1: "bare: 1, 2; unknown, taken as bare: 5".
std::string coating_summary(const LensSystem& lens);

/// Coating between two media, or on a mirror, for light of one wavelength from one side. An unknown coating counts as
/// bare glass on a refracting surface and as a perfect reflector on a mirror; callers that report its values must say
/// so.
class CoatedSurface {
public:
    /// `before`, `behind`: refractive indices of the media in the light's order, equal for a mirror. `as_listed`: true
    /// if the light crosses the layers in the order of the list. Throws InputError if a layer's index is unknown at the
    /// wavelength.
    CoatedSurface(const Coating& coating, bool is_mirror, double wavelength_nm, double before, double behind,
                  bool as_listed);

    /// Returns the reflection and transmission at one angle. `cosine`: cosine of the angle of incidence, 0 to 1, in the
    /// incident medium.
    PolarisedResponse at(double cosine) const;

    bool is_mirror() const { return is_mirror_; }

private:
    /// Returns the material's index. Throws InputError if it is unknown, or if the wavelength is at or beyond a
    /// resonance.
    static std::complex<double> known_index(const CoatingMaterial& material, double wavelength_nm);

    FilmStack stack_;
    bool is_mirror_;
    bool has_stated_reflectance_;  ///< the reflectance is `stated_reflectance_` at all angles; the stack is not used
    double stated_reflectance_;
};

/// Returns surface `index` (from 0) of a lens for light of one wavelength travelling to the film or to the scene.
/// `indices`: result of lens.indices(wavelength_nm). Throws InputError, naming surface and material, if a layer's index
/// is unknown.
CoatedSurface coated_surface(const LensSystem& lens, std::size_t index, double wavelength_nm, LightDirection direction,
                             const std::vector<double>& indices);

/// Returns all surfaces of a lens in the order of the light; std::nullopt for stops and apertures, which block light or
/// pass it unchanged. Throws InputError if an index is unknown.
std::vector<std::optional<CoatedSurface>> coated_surfaces(const LensSystem& lens, double wavelength_nm,
                                                          LightDirection direction);

}  // namespace REALCAM_NAMESPACE
