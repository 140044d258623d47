#pragma once
#include <vector>

#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Request for an outline: a film point, and the box about whose centre the outline is searched. The outline is that of
/// the half above the centre, or of the half below if half_height is negative.
struct OutlineLook {
    Vec2<double> film;  ///< mm
    PupilDirection centre;
    double half_width, half_height;
    double cos = 1, sin = 0;  ///< of the azimuth by which the box is rotated about its centre

    /// Direction at an azimuth of the outline (PupilOutline::direction) and a radius.
    PupilDirection direction(int azimuth, double reach) const;
    /// Unit of the radius at an azimuth of the outline.
    PupilDirection unit(int azimuth) const;
};

/// Resolution of a search along scan lines: number of radii that are scanned, and of bisections of the interval between
/// two.
struct OutlineScan {
    int steps = 20, halvings = 9;
};

/// Searches outlines at several film points by bisection along radial scan lines. A block of rays holds
/// azimuths of several requests, and several rays of each azimuth if there are few.
class OutlineSearch {
public:
    /// Tolerance for outlines searched near the mean of their neighbours, in units of the box.
    static constexpr double kChange = 0.005;

    /// Upper bound of the number of ray blocks for `looks` outlines: without any near its expected outline, two
    /// intervals for each edge, and a scan.
    static constexpr int most_blocks(int looks) {
        constexpr int kNarrowings = 2 * (2 + 4) + 2 * (2 + 7), kScan = OutlineScan{}.steps + 2 * OutlineScan{}.halvings;
        constexpr int kSmallGroups = (kBlock + kSmallGroup - 1) / kSmallGroup;
        return ((looks * kScanLines + kBlock - 1) / kBlock + kSmallGroups) * (kNarrowings + kScan);
    }

    /// `scan`: of at most kMostSteps steps.
    static std::vector<PupilOutline> find(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                          OutlineScan scan = {});

    /// Finds outlines near an expected one for each request. Its edges are searched within `tolerance` (in units of the
    /// box), which takes a quarter of the rays, and then within eight times as much. Azimuths without an edge in that
    /// interval, and those that are dark in the expected outline, are scanned.
    static std::vector<PupilOutline> find_near(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                                               const std::vector<PupilOutline>& expected, double tolerance);

private:
    static constexpr int kBlock = PupilLens::kBlock, kScanLines = PupilOutline::kAzimuths + 1;
    /// Scan lines of a group if all scan lines together do not fill a block. Seven rays of each are traced at once,
    /// which cover three bisections.
    static constexpr int kSmallGroup = kBlock / 7;
    static constexpr int kMostSteps = 48;
    static constexpr double kReach = 1.5;  ///< past the corner of the box
    static constexpr double kPrecision = 6e-4;  ///< approximate precision of edges near expected ones

    /// Indices of scan lines, numbered consecutively over all requests.
    using ScanLines = std::vector<int>;

    OutlineSearch(const std::vector<OutlineLook>& looks, const int* scan_lines, int count);

    static ScanLines scan_lines_of(const std::vector<OutlineLook>& looks);

    /// Calls task(group, position of its first scan line) for scan lines that are searched together, on any threads.
    template <class Task>
    static void for_each_group(const PupilLens& lens, const std::vector<OutlineLook>& looks,
                               const ScanLines& scan_lines, Task&& task);

    static void scan_all(const PupilLens& lens, const std::vector<OutlineLook>& looks, const ScanLines& scan_lines,
                         OutlineScan scan, std::vector<PupilOutline>& outlines);

    /// Scans outwards along each azimuth, then bisects the first and the last interval in which the light changes.
    void scan(const PupilLens& lens, OutlineScan scan);

    /// Bisects the intervals around the expected edges. Sets `found` to true for scan lines whose intervals contain the
    /// edges.
    void narrow(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance, bool* found);

    /// Clears `found` for scan lines on which light does not pass at `open`, or passes at `shut`.
    void test(const PupilLens& lens, const double (&open)[kBlock], const double (&shut)[kBlock], bool* found);

    /// Bisects the interval between a radius at which light passes and one at which it does not.
    void halve(const PupilLens& lens, int halvings, double (&open)[kBlock], double (&shut)[kBlock]);

    /// Traces `reaches` rays of each scan line; ray k of the i-th scan line is at radius reach(i, k).
    template <class Reach>
    void trace(const PupilLens& lens, int reaches, Reach&& reach);

    /// True if this ray of the last trace passed.
    bool passes(int scan_line, int ray) const { return passes_[ray * count_ + scan_line]; }

    /// Writes the edges of the scan lines that are `found`, or of all scan lines if it is null.
    void write(const bool* found, std::vector<PupilOutline>& outlines) const;

    const int* scan_lines_;
    int count_;
    Vec2<double> film_[kBlock];
    PupilDirection centre_[kBlock], unit_[kBlock];
    double outer_[kBlock], inner_[kBlock];
    bool passes_[kMostSteps * kBlock];
};

}  // namespace REALCAM_NAMESPACE
