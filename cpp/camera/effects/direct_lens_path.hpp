#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../optics/ghost/ghost_coatings.hpp"
#include "../../optics/trace/lens_path.hpp"
#include "dispersion/film_spectrum.hpp"
#include "entrance_pupil_search.hpp"
#include "ghosts/ghost_view.hpp"

namespace REALCAM_NAMESPACE {

/// True if the code for rotationally symmetric lenses handles a lens and its film.
bool uses_rotational_code(const LensSystem& lens);

/// Direct (ghost-free) lens path of light to the film, on which only mirrors reflect. It is represented as a GhostView
/// with a single path and without reflections, so that the code that traces ghosts from the lights also traces the
/// lights' own images and starbursts. Owns the memory of its views.
class DirectLensPath {
public:
    /// `spectrum`: for pictures whose samples have wavelengths, else std::nullopt. `effects`: effects that are
    /// simulated on the path. Throws InputError if a refractive index is unknown.
    DirectLensPath(const LensSystem& lens, const std::optional<FilmSpectrum>& spectrum, const Effects& effects);

    /// View for light of this kind. `pixel_samples`: see GhostView. The bounds of the entrance pupil are left empty.
    GhostView view(GhostLight light, std::int32_t pixel_samples) const;

    /// The lens for light towards the film.
    LensView<float> surfaces() const { return path_.view(); }

private:
    static constexpr std::array<float, 2> kCdf = {0, 1};  ///< the single path is chosen with probability 1

    Effects effects_;
    LensPath<float> path_;
    LensKind kind_;
    GhostLensPath only_path_;
    float reach_;  ///< entry_reach of the lens
    std::vector<IndexCubic> indices_;
    std::vector<GhostCoating<kOneWavelengthTerms>> coatings_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> spectral_coatings_;
};

}  // namespace REALCAM_NAMESPACE
