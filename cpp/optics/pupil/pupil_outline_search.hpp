#pragma once
#include <vector>

#include "pupil_lens.hpp"
#include "pupil_outline.hpp"

namespace REALCAM_NAMESPACE {

/// Request for the outline of half a region of passing directions: a film point, and the box about whose centre the
/// outline is searched. If half_height is negative, the lower half of the region is searched, and the outline is its
/// mirror image (see OutlineHalves).
struct OutlineRequest {
    Vec2<double> film;  ///< film point, mm
    PupilDirection centre;  ///< centre of the box
    double half_width, half_height;  ///< half-sides of the box, in optical direction cosines
    double cos = 1, sin = 0;  ///< cosine and sine of the angle by which the box is rotated about its centre

    /// Returns the direction at an azimuth (index, see PupilOutline::direction) and a radius of the outline.
    PupilDirection direction(int azimuth, double radius) const;
    /// Returns the difference of directions that corresponds to a radius of 1 at an azimuth of the outline.
    PupilDirection unit(int azimuth) const;
};

/// Resolution of a search along radial scan lines.
struct OutlineScan {
    int steps = 20;  ///< number of radii at which a scan line is sampled, at most OutlineSearch::kMaxSteps
    int bisections = 9;  ///< of each interval between two samples that contains an edge
};

/// Searches the outlines of several requests together, by bisection along radial scan lines. There is a scan line for
/// each azimuth of each request. A block of rays contains rays of many scan lines, and several rays of each if there
/// are few scan lines.
class OutlineSearch {
public:
    /// Tolerance of find_near for outlines that are searched near the mean of their neighbours.
    static constexpr double kNeighbourTolerance = 0.005;

    /// Upper bound of the number of ray blocks for a number of requests. In the worst case no outline is near the
    /// expected one: two intervals are then bisected for each edge, and the scan lines are scanned.
    static constexpr int max_blocks(int requests) {
        constexpr int kNearSearches = 2 * (2 + 4) + 2 * (2 + 7),
                      kScan = OutlineScan{}.steps + 2 * OutlineScan{}.bisections;
        constexpr int kSmallGroups = (kBlock + kSmallGroup - 1) / kSmallGroup;
        return ((requests * kScanLines + kBlock - 1) / kBlock + kSmallGroups) * (kNearSearches + kScan);
    }

    /// Returns the outline of each request.
    static std::vector<PupilOutline> find(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                                          OutlineScan scan = {});

    /// Returns the outline of each request, searched near `expected`, one outline per request. Edges are first searched
    /// within `tolerance` (a difference of radii), which takes a quarter of the rays of a scan, and then within eight
    /// times the tolerance. Azimuths without an edge there, and those that are dark in the expected outline, are
    /// scanned.
    static std::vector<PupilOutline> find_near(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                                               const std::vector<PupilOutline>& expected, double tolerance);

private:
    static constexpr int kBlock = PupilLens::kBlock;  ///< rays of a block
    static constexpr int kScanLines = PupilOutline::kAzimuths + 1;  ///< scan lines of a request
    /// Number of scan lines of a group if all scan lines together do not fill a block. Then seven rays of each scan
    /// line are traced together, which are enough for three bisections.
    static constexpr int kSmallGroup = kBlock / 7;
    static constexpr int kMaxSteps = 48;
    static constexpr double kMaxRadius = 1.5;  ///< scan lines end past the corners of the box
    static constexpr double kPrecision = 6e-4;  ///< approximate precision of edges that are found near expected ones

    /// Indices of scan lines: request index * kScanLines + azimuth.
    using ScanLines = std::vector<int>;

    /// A group of `count` scan lines, whose indices begin at `scan_lines`.
    OutlineSearch(const std::vector<OutlineRequest>& requests, const int* scan_lines, int count);

    /// Returns all scan lines of the requests.
    static ScanLines scan_lines_of(const std::vector<OutlineRequest>& requests);

    /// Divides scan lines into groups that are searched together, and calls task(group, position of the group's first
    /// scan line in `scan_lines`) for each, on any threads.
    template <class Task>
    static void for_each_group(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                               const ScanLines& scan_lines, Task&& task);

    /// Scans all given scan lines and stores their edges in the outlines of their requests.
    static void scan_all(const PupilLens& lens, const std::vector<OutlineRequest>& requests,
                         const ScanLines& scan_lines, OutlineScan scan, std::vector<PupilOutline>& outlines);

    /// Samples each scan line outwards, then bisects the interval before the first radius at which light passes (for
    /// the inner edge) and the one behind the last (for the outer edge).
    void scan(const PupilLens& lens, OutlineScan scan);

    /// Bisects the intervals of +-tolerance around the expected edges. Sets `found` for each scan line: true if the
    /// intervals contain its edges.
    void bisect_near(const PupilLens& lens, const std::vector<PupilOutline>& expected, double tolerance, bool* found);

    /// Sets `found` to false for scan lines on which light does not pass at radius `lit`, or passes at radius `dark`.
    void check_intervals(const PupilLens& lens, const double (&lit)[kBlock], const double (&dark)[kBlock], bool* found);

    /// Bisects, on each scan line, the interval between a radius at which light passes (`lit`) and one at which it does
    /// not
    /// (`dark`); both are updated.
    void bisect(const PupilLens& lens, int bisections, double (&lit)[kBlock], double (&dark)[kBlock]);

    /// Traces `radii` rays of each scan line. Ray k of scan line i of the group is at the radius radius(i, k).
    template <class Radius>
    void trace(const PupilLens& lens, int radii, Radius&& radius);

    /// True if a ray of the last call of trace passed.
    bool passes(int scan_line, int ray) const { return passes_[ray * count_ + scan_line]; }

    /// Stores the edges in the outlines: of the scan lines for which `found` is true, or of all if `found` is null.
    void store(const bool* found, std::vector<PupilOutline>& outlines) const;

    const int* scan_lines_;  ///< indices of the group's scan lines
    int count_;
    // For each scan line of the group: film point, its origin and unit of radius, and the radii of its edges.
    Vec2<double> film_[kBlock];
    PupilDirection centre_[kBlock], unit_[kBlock];
    double outer_[kBlock], inner_[kBlock];
    bool passes_[kMaxSteps * kBlock];  ///< results of the last call of trace
};

}  // namespace REALCAM_NAMESPACE
