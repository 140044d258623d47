#pragma once
#include <optional>
#include <vector>

#include "pupil_box.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// Reach of the passing directions from the middle of their bounding box, in units of the box, by azimuth from 0 to pi.
struct PupilOutline {
    static constexpr int kAzimuths = 64;  ///< intervals of azimuth

    double outer[kAzimuths + 1] = {}, inner[kAzimuths + 1] = {};

    static PupilDirection direction(int spoke) { return fine_direction(spoke * kFine); }

    static constexpr int kFine = 16;  ///< finer ones in each interval
    /// A direction of unit length.
    static PupilDirection fine_direction(int i);
};

/// The whole box, and a little more. At the edge of the image circle the last light comes through a crescent, thin
/// and bent, that spokes from its middle do not describe.
PupilOutline box_outline();

/// How much the reach along an azimuth differs between outlines.
double spread(const std::vector<PupilOutline>& looks, int azimuth);

double largest_spread(const std::vector<PupilOutline>& looks);

/// By how much the outer edges of the same looks differ, mean of all azimuths in units of the box. One that is dark in
/// one and lit in the other counts as one unit.
double mean_difference(const std::vector<PupilOutline>& a, const std::vector<PupilOutline>& b);

/// The mean of these: what lies between them looks about so. Nothing at azimuths at which some are dark and others not,
/// or only some have a hole.
PupilOutline between(const std::vector<const PupilOutline*>& looks);

/// The outline that holds all of these, and a margin: a share of the reach, for what can pass between the film radii
/// and azimuths looked at, and a share of how much it changes.
PupilOutline holding_all(const std::vector<PupilOutline>& looks);

/// Sectors of one row, first to last in azimuth.
class PupilRow {
public:
    static constexpr int kSectors = 32;  ///< for m >= 0

    /// Cuts the outline into sectors of nearly equal area.
    explicit PupilRow(const PupilOutline& outline);

    /// Widens the sector of a place in the box such that it holds it; false where it does already.
    bool take_in(Vec2f place);

    /// A place just outside of a sector's edge, or just inside its hole.
    Vec2f beside(std::size_t sector, Vec2f u) const;

    const std::vector<PupilSector>& sectors() const { return sectors_; }

    /// Of all sectors without their holes, in units of the box's half-widths.
    double area() const;

private:
    struct Point {
        double x, y;
    };

    /// Nothing for a place with m < 0, and for one that falls between two sectors by rounding.
    std::optional<std::size_t> sector_of(Vec2f place) const;
    /// 1 on the sector's outer edge.
    static float reach_in(const PupilSector& s, Vec2f place) {
        return (place.x * s.dy - place.y * s.dx) / (s.x * s.dy - s.y * s.dx);
    }
    static bool holds(const PupilSector& s, float reach) { return reach <= 1 && reach * reach >= s.hole_squared; }

    /// The smallest triangle on these two azimuths whose outer edge lies outside the outline in between.
    static PupilSector sector_over(const double* outer, const double* inner, int from, int to);

    std::vector<PupilSector> sectors_;
};

}  // namespace REALCAM_NAMESPACE
