#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Sectors of a region: of its upper half, and of its lower half mirrored upwards. For a region that is symmetric in m,
/// only those of the upper half.
using PupilHalves = std::vector<PupilRow>;

/// Search for light outside the sectors of a region (stray rays). Traces random rays through the region's surroundings,
/// and enlarges sectors until they contain all rays that pass. This catches corners of slivers between the scan lines
/// of an outline search, and ends of crescents between grid points.
class StraySearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    using Points = Vec2Lanes<float, kBlock>;
    /// Sets the rays of a round: chooses a film point in the cell for each ray, and directs the ray to the given point,
    /// which is in units of the half-widths of the box at that film point. `stream`: random stream of the round.
    using SetRays = std::function<void(int round, std::uint32_t stream, const Points& points, PupilRays& rays)>;

    /// Numbers of rays of a search.
    struct Traced {
        int all_over = 0;  ///< rays traced all over the surroundings
        int passed_all_over = 0;  ///< those of them that passed the lens
        int passed_beside = 0;  ///< rays traced just beside the sectors that passed the lens
    };

    int max_rounds;  ///< largest number of rounds, each of kBlock rays
    std::uint32_t cell;  ///< index of the cell (or row) of the film map, which determines the random numbers
    int dimension;  ///< index of the pair of random dimensions for the points; SetRays may use others
    double half_size;  ///< half the size of the surroundings, in units of the box's half-widths
    int clean_rounds;  ///< number of successive rounds without a stray ray after which the search ends

    /// Enlarges the sectors of `halves`. Rounds alternate between rays all over the surroundings and rays just beside
    /// the edges of sectors.
    Traced widen(const PupilLens& lens, const SetRays& set_rays, PupilHalves& halves) const;

private:
    /// Samples points all over the surroundings.
    Points points_all_over(std::uint32_t stream, bool is_symmetric) const;
    /// Samples points just beside the edges of all sectors in turn.
    Points points_beside(std::uint32_t stream, const PupilHalves& halves) const;
};

}  // namespace REALCAM_NAMESPACE
