#pragma once
#include <vector>

#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// A film point whose outline is looked for, and the box about whose middle it lies. The outline is that of the half
/// above the middle, or below, where half_height is negative.
struct OutlineLook {
    Vec2<double> film;  ///< mm
    PupilDirection centre;
    double half_width, half_height;
};

/// The outlines at some film points. Each ray of a block has an azimuth of its own, of whichever of the looks.
class OutlineSearch {
public:
    /// For `looks` looks.
    static constexpr int most_blocks(int looks) {
        return (looks * kSpokes + kBlock - 1) / kBlock * (kSteps + 2 * kHalvings);
    }

    static std::vector<PupilOutline> find(const PupilLens& lens, const std::vector<OutlineLook>& looks);

private:
    static constexpr int kBlock = PupilLens::kBlock, kSpokes = PupilOutline::kAzimuths + 1;
    static constexpr int kSteps = 20, kHalvings = 9;
    static constexpr double kReach = 1.5;  ///< past the corner of the box

    OutlineSearch(const std::vector<OutlineLook>& looks, int first, int count);

    /// Scans outwards along each azimuth, then halves the last and the first interval at which the light changes.
    void scan(const PupilLens& lens);

    /// Narrows the interval between a reach that passes and one that does not.
    void halve(const PupilLens& lens, double (&open)[kBlock], double (&shut)[kBlock]);

    void trace(const PupilLens& lens);

    void write(std::vector<PupilOutline>& outlines) const;

    int first_, count_;
    PupilRays rays_;
    PupilDirection centre_[kBlock], unit_[kBlock];
    double reach_[kBlock], outer_[kBlock], inner_[kBlock];
    bool passes_[kBlock];
};

}  // namespace REALCAM_NAMESPACE
