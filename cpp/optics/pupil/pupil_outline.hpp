#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "direction_box.hpp"
#include "pupil_view.hpp"

namespace REALCAM_NAMESPACE {

/// Upper half of the outline of a region of passing directions, in polar coordinates about the centre of the region's
/// bounding box, in which half the width and half the height of the box are the units. Radii are tabulated at equally
/// spaced azimuths from 0 to pi (towards larger m). An azimuth with the outer radius 0 is dark: no light passes there.
struct PupilOutline {
    static constexpr int kAzimuths = 64;  ///< number of intervals of azimuth

    double outer[kAzimuths + 1] = {};  ///< radius of the outer edge
    double inner[kAzimuths + 1] = {};  ///< radius of the edge of a central obstruction (hole); 0: no hole

    /// Unit vector at azimuth pi `azimuth` / kAzimuths.
    static PupilDirection direction(int azimuth) { return fine_direction(azimuth * kFine); }

    static constexpr int kFine = 16;  ///< subdivisions of each interval, for fine_direction
    /// Unit vector at azimuth pi i / (kAzimuths kFine).
    static PupilDirection fine_direction(int i);
};

/// Returns the outline of the whole box with a margin. It is used at the edge of the image circle, where light passes
/// through a thin, curved crescent, which radii from the centre of its box cannot describe.
PupilOutline box_outline();

/// Returns the largest minus the smallest outer radius of several outlines at an azimuth.
double radius_range(const std::vector<PupilOutline>& outlines, int azimuth);

/// Returns the largest radius_range over all azimuths.
double largest_radius_range(const std::vector<PupilOutline>& outlines);

/// Returns the mean absolute difference of the outer radii of a[i] and b[i] over all i and azimuths. An azimuth that is
/// dark in exactly one of the two counts as a difference of 1.
double mean_difference(const std::vector<PupilOutline>& a, const std::vector<PupilOutline>& b);

/// Returns the mean of outlines, as an estimate of an outline between them. It is dark at azimuths at which an outline
/// is dark, or at which only some of the outlines have a hole.
PupilOutline mean_outline(const std::vector<const PupilOutline*>& outlines);

/// Returns an outline that contains all given outlines. Its margin, for light between the searched film radii and
/// azimuths, is a fraction of the radius plus a fraction of the range of radii.
PupilOutline enclosing_outline(const std::vector<PupilOutline>& outlines);

/// Sectors of the upper half of a region (one row of the pupil's table), in the order of their azimuths. Points are in
/// units of the half-widths of the box, relative to its centre.
class PupilRow {
public:
    static constexpr int kSectors = kPupilSectors;  ///< sectors for m >= 0

    /// Divides the outline into sectors of nearly equal area.
    explicit PupilRow(const PupilOutline& outline);

    /// Enlarges the sector at the azimuth of a point, or shrinks its hole, so that it contains the point. Returns false
    /// if no change was necessary, or if the point has no sector.
    bool extend_to(Vec2f point);

    /// Samples a point just outside the outer edge of a sector, or just inside its hole. `u`: random numbers in [0, 1).
    Vec2f sample_beside(std::size_t sector, Vec2f u) const;

    const std::vector<PupilSector>& sectors() const { return sectors_; }

    /// Returns the area of all sectors without their holes.
    double area() const;

private:
    struct Point {
        double x, y;
    };

    /// Returns the index of the sector at a point's azimuth; std::nullopt for a point with m < 0, or if the point falls
    /// between two sectors by rounding.
    std::optional<std::size_t> sector_of(Vec2f point) const;
    /// Returns the distance of a point from the centre, relative to that of the sector's outer edge at the same
    /// azimuth.
    static float relative_radius(const PupilSector& s, Vec2f point) {
        return (point.x * s.dy - point.y * s.dx) / (s.x * s.dy - s.y * s.dx);
    }
    /// True if a point at a sector's azimuth with this relative radius lies between the sector's inner and outer edges.
    static bool contains(const PupilSector& s, float radius) {
        return radius <= 1 && radius * radius >= s.hole_squared;
    }

    /// Returns the smallest sector between two azimuths that contains the outline. `outer`, `inner`: radii at fine
    /// azimuths (PupilOutline::fine_direction); `from`, `to`: indices of the two azimuths.
    static PupilSector sector_over(const double* outer, const double* inner, int from, int to);

    std::vector<PupilSector> sectors_;
};

/// Outline of a whole region: its upper half, and its lower half mirrored upwards.
using OutlineHalves = std::array<PupilOutline, 2>;

/// Azimuth of an OutlineHalves over a full turn.
struct TurnAzimuth {
    std::size_t half;  ///< 0: upper half; 1: lower half
    int azimuth;  ///< index of the azimuth in that half
    Vec2<double> direction;  ///< unit vector

    /// `i`: from 0 to 2 PupilOutline::kAzimuths - 1, counter-clockwise from the direction of l.
    explicit TurnAzimuth(int i);
};

/// Converts an outline in the box `from` to one in the box `to`: about its centre, and in its units. The outline is
/// assumed to be straight between azimuths. Returns dark outlines if the region does not surround the centres of both
/// boxes.
OutlineHalves moved_outline(const OutlineHalves& outline, const DirectionBox& from, const DirectionBox& to);

}  // namespace REALCAM_NAMESPACE
