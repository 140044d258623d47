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
bool is_round_lens(const LensSystem& lens);

/// Direct (ghost-free) lens path of light to the film, on which only mirrors reflect. Owns the memory of its views.
class DirectLensPath {
public:
    /// `spectrum`: for pictures whose samples have wavelengths. Throws InputError if a refractive index is unknown.
    DirectLensPath(const LensSystem& lens, const std::optional<FilmSpectrum>& spectrum, const Effects& effects);

    /// `pixel_samples`: see GhostView.
    GhostView view(GhostLight light, std::int32_t pixel_samples) const;

    LensView<float> surfaces() const { return path_.view(); }

private:
    static constexpr std::array<float, 2> kCdf = {0, 1};

    Effects effects_;
    LensPath<float> path_;
    LensKind kind_;
    GhostLensPath only_path_;
    float reach_;
    std::vector<IndexCubic> indices_;
    std::vector<GhostCoating<kOneWavelengthTerms>> coatings_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> spectral_coatings_;
};

}  // namespace REALCAM_NAMESPACE
