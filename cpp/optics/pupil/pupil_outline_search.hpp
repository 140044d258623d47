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

/// The outlines at some film points. A block of rays holds azimuths of whichever of the looks, and several rays of each
/// where they are few.
class OutlineSearch {
public:
    /// By how much outlines may differ from those in the middle between which they lie, units of the box.
    static constexpr double kChange = 0.005;

    /// For `looks` looks, if none is as expected: two intervals for each edge, and a scan.
    static constexpr int most_blocks(int looks) {
        constexpr int kNarrowings = 2 * (2 + 4) + 2 * (2 + 7), kScan = kSteps + 2 * kHalvings;
        constexpr int kSmallGroups = (kBlock + kSmallGroup - 1) / kSmallGroup;
        return ((looks * kSpokes + kBlock - 1) / kBlock + kSmallGroups) * (kNarrowings + kScan);
    }

    static std::vector<PupilOutline> find(const PupilLens& lens, const std::vector<OutlineLook>& looks);

    /// The same where an outline is expected for each look. Its edges are looked for within `tolerance` (in units of
    /// the box), which takes a quarter of the rays, and then within eight times as much. Azimuths without an edge
    /// there, and those whose expected outline has none, are scanned.
    static std::vector<PupilOutline> find_near(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                               const std::vector<PupilOutline>& expected, double tolerance);

private:
    static constexpr int kBlock = PupilLens::kBlock, kSpokes = PupilOutline::kAzimuths + 1;
    /// Spokes of a group where all are too few for a block. Of each seven rays are traced at once, which are those of
    /// three halvings.
    static constexpr int kSmallGroup = kBlock / 7;
    static constexpr int kSteps = 20, kHalvings = 9;
    static constexpr double kReach = 1.5;  ///< past the corner of the box
    static constexpr double kPrecision = 6e-4;  ///< about that of edges near expected ones

    /// Spokes count on from look to look.
    using Spokes = std::vector<int>;

    OutlineSearch(const std::vector<OutlineLook>& looks, const int* spokes, int count);

    static Spokes spokes_of(const std::vector<OutlineLook>& looks);

    /// Calls task(group, its first spoke) for spokes that are searched together, on any threads.
    template <class Task>
    static void for_each_group(const PupilLens& lens, const std::vector<OutlineLook>& looks, const Spokes& spokes,
                               Task&& task);

    static void scan_all(const PupilLens& lens, const std::vector<OutlineLook>& looks, const Spokes& spokes,
                         std::vector<PupilOutline>& outlines);

    /// Scans outwards along each azimuth, then halves the last and the first interval at which the light changes.
    void scan(const PupilLens& lens);

    /// Halves the intervals around the expected edges. Sets `found`, of each spoke, to whether they hold the edges.
    void narrow(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance, bool* found);

    /// Whether light passes at one reach of each spoke and not at the other.
    void test(const PupilLens& lens, const double (&open)[kBlock], const double (&shut)[kBlock], bool* found);

    /// Narrows the interval between a reach that passes and one that does not.
    void halve(const PupilLens& lens, int halvings, double (&open)[kBlock], double (&shut)[kBlock]);

    /// Traces `reaches` rays of each spoke, ray k of the i-th spoke to its reach(i, k).
    template <class Reach>
    void trace(const PupilLens& lens, int reaches, Reach&& reach);

    /// Whether this ray of those traced last passes.
    bool passes(int spoke, int ray) const { return passes_[ray * count_ + spoke]; }

    /// Those of the spokes that are `found`; null: of all.
    void write(const bool* found, std::vector<PupilOutline>& outlines) const;

    const int* spokes_;
    int count_;
    Vec2<double> film_[kBlock];
    PupilDirection centre_[kBlock], unit_[kBlock];
    double outer_[kBlock], inner_[kBlock];
    bool passes_[kSteps * kBlock];
};

}  // namespace REALCAM_NAMESPACE
