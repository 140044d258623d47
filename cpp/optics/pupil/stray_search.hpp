#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Sectors of the halves of a region above and below the centre of its box; of a region symmetric in m, of the upper
/// half alone.
using PupilHalves = std::vector<PupilRow>;

/// Traces random rays through the surroundings of a region, which is described by sectors, and widens the sectors that
/// do not contain a passing ray. This catches corners of slivers between spokes, and ends of crescents between grid
/// points.
class StraySearch {
public:
    static constexpr int kBlock = PupilTracer::kBlock;
    using Places = Vec2Lanes<float, kBlock>;
    /// Sets rays of a film map's cell: to these points, in units of the box at each ray's film point.
    using SetRays = std::function<void(int round, std::uint32_t stream, const Places& places, PupilRays& rays)>;

    /// Rays that were traced all over the surroundings, those of them that passed, and those that passed beside the
    /// sectors.
    struct Traced {
        int around = 0, around_passed = 0, beside_passed = 0;
    };

    int most_rounds;
    std::uint32_t cell;  ///< index of the film map's cell, to which the random numbers belong
    int dimension;  ///< of the random numbers for the points; the others are left to SetRays
    double reach;  ///< size of the surroundings, in units of the box's half-widths
    int clean_rounds;

    /// Traces all over the surroundings in one round and just beside the sectors in the next, until `clean_rounds`
    /// rounds in succession find no ray to add.
    Traced widen(const PupilLens& lens, const SetRays& set_rays, PupilHalves& halves) const;

private:
    Places points_around(std::uint32_t stream, bool is_symmetric) const;
    Places points_beside(std::uint32_t stream, const PupilHalves& halves) const;
};

}  // namespace REALCAM_NAMESPACE
