#pragma once
#include <array>
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "../trace/lens_path.hpp"
#include "pupil_box.hpp"
#include "pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// The edges of the light that a film point sees in the lens, as closed polygons in optical direction cosines:
/// counter-clockwise around the light, clockwise around what blocks it in the middle.
using PupilEdges = std::vector<std::vector<Vec2<double>>>;

/// Finds them with real rays along spokes, at the design wavelength: rims, blades and whatever else stops light.
class PupilEdgeSearch {
public:
    static constexpr int kSpokes = PupilTracer::kBlock / 2;

    PupilEdgeSearch(const LensSystem& lens, const PupilTracer& tracer);

    /// The edges for the film point at this radius (mm) and azimuth (rad). `box`: what holds the light for azimuth 0,
    /// from whose middle the spokes go. Nothing where some spoke meets no light, as in a crescent at the edge of the
    /// image.
    std::optional<PupilEdges> at(double radius, double azimuth, const PupilBox& box) const;

private:
    static constexpr int kSteps = 48, kHalvings = 16;
    static constexpr double kReach = 1.5;  ///< past the corner of the box

    struct Spokes {
        Spokes(double radius, double azimuth, const PupilBox& box, double film_distance);

        /// At a share of the way from the middle of the box to the ellipse in it. Spokes are numbered twice.
        Vec2<double> direction(int spoke, double reach) const;

        PupilBox box;
        double cos, sin;
        Vec3d film;
    };

    std::array<bool, 2 * kSpokes> trace(const Spokes& spokes, const std::array<double, 2 * kSpokes>& reach) const;

    /// Sets the last steps in and out of the light. False where a spoke meets none. A spoke whose middle is lit has its
    /// inner edge there.
    bool scan(const Spokes& spokes, std::array<double, 2 * kSpokes>& lit, std::array<double, 2 * kSpokes>& dark) const;

    static double reach_at(int step) { return kReach * step / kSteps; }

    LensPath<float> path_;
    double film_distance_;
    const PupilTracer& tracer_;
};

}  // namespace REALCAM_NAMESPACE
