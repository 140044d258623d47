#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "../trace/lens_path.hpp"
#include "direction_box.hpp"
#include "pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// Edges of the pupil as seen from a film point, as closed polygons in optical direction cosines: counter-clockwise
/// around the light, clockwise around a central obstruction.
using PupilEdges = std::vector<std::vector<Vec2<double>>>;

/// Finds pupil edges by tracing real rays along radial scan lines (spokes), at the design wavelength: rims, blades and
/// all else that blocks light.
class PupilEdgeSearch {
public:
    static constexpr int kSpokes = PupilTracer::kBlock / 2;

    PupilEdgeSearch(const LensSystem& lens, const PupilTracer& tracer);

    /// Returns the edges for the film point at this radius (mm) and azimuth (rad). `box`: bounding box of the light for
    /// azimuth 0, from whose centre the spokes start. Returns std::nullopt if a spoke meets no light, as in a crescent
    /// at the edge of the image.
    std::optional<PupilEdges> at(double radius, double azimuth, const DirectionBox& box) const;

private:
    static constexpr int kSteps = 48, kHalvings = 16;
    static constexpr double kReach = 1.5;  ///< past the corner of the box

    struct Spokes {
        Spokes(double radius, double azimuth, const DirectionBox& box, double film_distance);

        /// Direction on a spoke; `reach` is 0 at the centre of the box and 1 on the ellipse inscribed in it. Indices
        /// run over the spokes twice.
        Vec2<double> direction(int spoke, double reach) const;

        DirectionBox box;
        double cos, sin;
        Vec3d film;
    };

    std::array<bool, 2 * kSpokes> trace(const Spokes& spokes, const std::array<double, 2 * kSpokes>& reach) const;

    /// Sets, for both edges of each spoke, the last lit step and the dark one beyond. Returns false if a spoke meets no
    /// light. The inner edge of a spoke that starts in light is at the centre.
    bool scan(const Spokes& spokes, std::array<double, 2 * kSpokes>& lit, std::array<double, 2 * kSpokes>& dark) const;

    static double reach_at(int step) { return kReach * step / kSteps; }

    LensPath<float> path_;
    double film_distance_;
    const PupilTracer& tracer_;
};

}  // namespace REALCAM_NAMESPACE
