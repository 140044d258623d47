#pragma once
#include <vector>

#include "../dispersion/film_spectrum.hpp"
#include "../entrance_pupil_search.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

namespace ghost_tables_detail {

/// Index of a crossing in all_crossings().
inline std::size_t crossing_index(const Crossing& crossing) {
    return static_cast<std::size_t>(4 * crossing.surface + 2 * crossing.in_order + crossing.is_reflected);
}

/// Every crossing of a surface that an optical path may have: in both directions, refracted and reflected.
std::vector<Crossing> all_crossings(const LensSystem& lens);

}  // namespace ghost_tables_detail

/// Ghosts of a lens of any kind, prepared for rendering. Owns the memory of its views.
class GhostTables {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. `spectrum`: for pictures with dispersion, else
    /// null. Throws InputError if a refractive index is unknown.
    GhostTables(const LensSystem& lens, double film_radius, const GhostChoice& choice, const PupilTracer& tracer,
                const FilmSpectrum* spectrum);

    /// Ghosts of lights.
    GhostView view() const { return view_of(to_film_, GhostLight::of_lights, 1, entry_reach_, directions_); }
    /// Ghosts of light that objects reflect. Their noise scales with their fraction of the light: if the number of
    /// their samples is twice that fraction of the pixel samples, they hardly add to the noise of the picture.
    GhostView view_of_objects() const;

    const std::vector<GhostPair>& pairs() const { return pairs_; }
    /// Light of the ghost of each pair on the film, as a fraction of the lens's own light, for a uniform surround.
    const std::vector<double>& shares() const { return shares_; }

private:
    /// Optical paths of all ghosts, for light towards the film or from the film to the scene.
    struct LensPaths {
        std::vector<GhostLensPath> paths;
        std::vector<GhostBounds> entries;
        std::vector<SurfaceView<float>> surfaces;
        // One element for each crossing of all paths, or empty:
        std::vector<FrameChanges<float>> frames;
        std::vector<FreeformView<float>> freeforms;
        std::vector<ApertureView<float>> apertures;
        std::vector<GhostCoating<kOneWavelengthTerms>> coatings;
        std::vector<IndexCubic> indices;
        std::vector<GhostCoating<kGhostSpectrumTerms>> spectral_coatings;
    };

    /// View of these paths. `pixel_samples`, `reach`, `grid`: see GhostView.
    GhostView view_of(const LensPaths& lens_paths, GhostLight light, std::int32_t pixel_samples, float reach,
                      const GhostGrid& grid) const;

    /// A pair whose ghost may be bright enough, and the product of its surfaces' axial reflectances and transmittances
    /// (AxialTransmittance).
    struct AxialPair {
        GhostPair pair;
        double share;
    };

    /// Finds the optical paths of these pairs, and keeps those with more than `least_share` of the lens's own light.
    /// `lens_with_film`: `lens` with the film as a mirror surface.
    template <class Map>
    void find_lens_paths(const EntrancePupilSearch<Map>& search, const LensSystem& lens,
                         const LensSystem& lens_with_film, const std::vector<AxialPair>& pairs, double least_share,
                         const PupilTracer& tracer);

    // Store the divisions of the directions and of the film into cells.
    void set_maps(const HalfTangentBins& directions, const FilmRings&) { largest_half_tangent_ = directions.largest; }
    void set_maps(const GhostGrid& directions, const FilmCells& film) {
        directions_ = directions;
        film_grid_ = film.grid;
    }

    /// Computes indices and coatings for each crossing that a path may have.
    void make_crossings(const LensSystem& lens, const FilmSpectrum* spectrum);

    /// Appends a path. `crossings`: in the order in which light along `path` meets them.
    void add(LensPaths& to, const LensPath<float>& path, const std::vector<Crossing>& crossings);

    /// Sets sampling probabilities: 90% in proportion to the paths' shares of the light, 10% uniform, because the
    /// actual light is not a uniform surround.
    void set_probabilities();

    Effects effects_;
    std::vector<GhostPair> pairs_;
    std::vector<double> shares_;
    LensPaths to_film_, to_scene_;
    std::vector<float> cdf_;
    std::vector<Crossing> all_;  ///< all_crossings of the lens; the next three hold one element for each, indexed by
                                 ///< ghost_tables_detail::crossing_index
    std::vector<GhostCoating<kOneWavelengthTerms>> all_coatings_;
    std::vector<IndexCubic> all_indices_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> all_spectral_;
    float film_radius_, film_index_, entry_reach_, exit_reach_;
    float largest_half_tangent_ = 0;
    GhostGrid directions_{}, film_grid_{};  ///< lenses without rotational symmetry only
    Iris<float> iris_{};
    LensKind kind_ = LensKind::rotational;
};

}  // namespace REALCAM_NAMESPACE
