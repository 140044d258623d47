#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "direction_box.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// Outline of the passing directions: radii from the centre of their bounding box, in units of its half-widths, at
/// azimuths from 0 to pi. An azimuth with outer radius 0 is dark.
struct PupilOutline {
    static constexpr int kAzimuths = 64;  ///< intervals of azimuth

    double outer[kAzimuths + 1] = {}, inner[kAzimuths + 1] = {};

    static PupilDirection direction(int azimuth) { return fine_direction(azimuth * kFine); }

    static constexpr int kFine = 16;  ///< subdivisions of each interval
    /// Unit vector at an azimuth, in units of pi / (kAzimuths kFine).
    static PupilDirection fine_direction(int i);
};

/// Outline of the whole box and a margin. At the edge of the image circle the last light passes through a thin, bent
/// crescent, which radii from its centre do not describe.
PupilOutline box_outline();

/// Range of the outer radius at an azimuth over several outlines.
double spread(const std::vector<PupilOutline>& looks, int azimuth);

double largest_spread(const std::vector<PupilOutline>& looks);

/// Mean difference of the outer radii of corresponding outlines, over all azimuths, in units of the box. An azimuth
/// that is dark in one outline and lit in the other counts as one unit.
double mean_difference(const std::vector<PupilOutline>& a, const std::vector<PupilOutline>& b);

/// Mean of outlines, an estimate of the outline between them. It is 0 at azimuths at which an outline is dark, or at
/// which only some outlines have a hole.
PupilOutline between(const std::vector<const PupilOutline*>& looks);

/// Outline that contains all of these, with a margin: a share of the radius, for light between the searched film radii
/// and azimuths, and a share of the radius's range.
PupilOutline holding_all(const std::vector<PupilOutline>& looks);

/// Sectors of one row, in order of azimuth.
class PupilRow {
public:
    static constexpr int kSectors = PupilView::kSectors;  ///< sectors for m >= 0

    /// Cuts the outline into sectors of nearly equal area.
    explicit PupilRow(const PupilOutline& outline);

    /// Widens the sector at a point in the box to contain the point; returns false if no sector was widened.
    bool take_in(Vec2f point);

    /// A point just outside a sector's edge, or just inside its hole. `u`: random numbers in [0, 1).
    Vec2f beside(std::size_t sector, Vec2f u) const;

    const std::vector<PupilSector>& sectors() const { return sectors_; }

    /// Area of all sectors without their holes, in units of the box's half-widths.
    double area() const;

private:
    struct Point {
        double x, y;
    };

    /// Returns std::nullopt for a point with m < 0, and for one that falls between two sectors by rounding.
    std::optional<std::size_t> sector_of(Vec2f point) const;
    /// Distance of a point from the centre; 1 on the sector's outer edge.
    static float reach_in(const PupilSector& s, Vec2f point) {
        return (point.x * s.dy - point.y * s.dx) / (s.x * s.dy - s.y * s.dx);
    }
    static bool holds(const PupilSector& s, float reach) { return reach <= 1 && reach * reach >= s.hole_squared; }

    /// The smallest triangle between these two azimuths whose outer edge lies outside the outline in between.
    static PupilSector sector_over(const double* outer, const double* inner, int from, int to);

    std::vector<PupilSector> sectors_;
};

/// Outline of a whole region: of its halves above and below the centre of its box.
using OutlineHalves = std::array<PupilOutline, 2>;

/// An azimuth over a whole turn: its half of the outline, its index in that half, and its direction.
struct TurnAzimuth {
    std::size_t half;
    int azimuth;
    Vec2<double> direction;

    /// `i`: from 0 to 2 PupilOutline::kAzimuths - 1.
    explicit TurnAzimuth(int i);
};

/// Returns the outline relative to the centre of another box, in units of that box. It is taken as straight between
/// azimuths. Returns an empty outline if the region does not surround the centres of both boxes.
OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to);

}  // namespace REALCAM_NAMESPACE
