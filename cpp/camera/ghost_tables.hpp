#pragma once
#include <vector>

#include "entry_search.hpp"
#include "film_spectrum.hpp"
#include "free_entry_search.hpp"
#include "ghost_choice.hpp"

namespace REALCAM_NAMESPACE {

namespace ghost_tables_detail {

/// Number of a crossing among all that a ghost's way may have.
inline std::size_t number_of(const Crossing& crossing) {
    return static_cast<std::size_t>(4 * crossing.surface + 2 * crossing.in_order + crossing.is_reflected);
}

std::vector<Crossing> all_crossings(const LensSystem& lens);

}  // namespace ghost_tables_detail

/// The ghosts of a lens of any kind made ready for pictures. Owns the memory of its views.
class GhostTables {
public:
    /// `film_radius`: of a circle that holds the film, mm. `spectrum`: of a picture with dispersion. Throws InputError
    /// where an index is not known.
    GhostTables(const LensSystem& of_lens, double film_radius, const GhostChoice& choice, const PupilTracer& tracer,
                const FilmSpectrum* spectrum);

    /// Ghosts of lights.
    GhostView view() const { return view_of(to_film_, GhostLight::of_lights, 1, entry_reach_, directions_); }
    /// Ghosts of what objects reflect. They are that share of the light, and so is their noise: twice as many samples
    /// as that share of the pixels' are enough for the noise of the picture to be hardly more.
    GhostView view_of_objects() const;

    const std::vector<GhostPair>& pairs() const { return pairs_; }
    /// What each pair brings, as a share of the light that the lens itself brings to the film from a uniform surround.
    const std::vector<double>& shares() const { return shares_; }

private:
    /// The ways of all ghosts for light that goes to the film, or back from there to the scene.
    struct Ways {
        std::vector<GhostWay> ways;
        std::vector<GhostEntry> entries;
        std::vector<FreeGhostEntry> free_entries;  ///< of a lens that is not of revolution, instead
        std::vector<SurfaceView<float>> surfaces;
        // Of all crossings, or empty:
        std::vector<FrameChanges<float>> frames;
        std::vector<FreeformView<float>> freeforms;
        std::vector<ApertureView<float>> apertures;
        std::vector<GhostCoating<kOneWavelengthTerms>> coatings;
        std::vector<IndexCubic> indices;
        std::vector<GhostCoating<kGhostSpectrumTerms>> spectral_coatings;
    };

    GhostView view_of(const Ways& of, GhostLight light, std::int32_t pixel_samples, float reach,
                      const GhostGrid& grid) const;

    /// A pair whose ghost may bring enough light, and by how much its surfaces weaken light along the axis.
    struct AxialPair {
        GhostPair pair;
        double share;
    };

    /// Finds the ways of these pairs. `lens`: with its film as a mirror.
    template <class Search>
    void find_ways(const Search& search, const LensSystem& of_lens, const LensSystem& lens,
                   const std::vector<AxialPair>& pairs, double least_share, const PupilTracer& tracer);

    // Of what was found by all ways, the last of them the lens's own: the range of directions, and where one way's
    // light enters the lens and leaves it.
    void set_range(const EntrySearch& search, const std::vector<std::vector<FoundRay>>& found);
    void set_range(const FreeEntrySearch& search, const std::vector<std::vector<FreeFoundRay>>& found);
    void add_entries(const std::vector<FoundRay>& found);
    void add_entries(const std::vector<FreeFoundRay>& found);

    /// What light does at each crossing that a way may have.
    void make_crossings(const LensSystem& lens, const FilmSpectrum* spectrum);

    /// `crossings`: in the order in which light meets them that goes along `path`.
    void add(Ways& to, const LensPath<float>& path, const std::vector<Crossing>& crossings);

    /// By what the ways bring to the film; a tenth without regard to it, because light comes from one side.
    void set_probabilities();

    Effects effects_;
    std::vector<GhostPair> pairs_;
    std::vector<double> shares_;
    Ways to_film_, to_scene_;
    std::vector<float> cdf_;
    std::vector<Crossing> all_;  ///< of which the next three are, by ghost_tables_detail::number_of
    std::vector<GhostCoating<kOneWavelengthTerms>> all_coatings_;
    std::vector<IndexCubic> all_indices_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> all_spectral_;
    float film_radius_, film_index_, entry_reach_, exit_reach_;
    float largest_half_tangent_ = 0;
    GhostGrid directions_{}, film_grid_{};  ///< of a lens that is not of revolution
    Iris<float> iris_{};
    LensKind kind_ = LensKind::rotational;
};

}  // namespace REALCAM_NAMESPACE
