#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "lines_of_sight.hpp"

namespace REALCAM_NAMESPACE {

/// What became of a point of the scene on its way to the film.
enum class ProjectionStatus {
    ok,
    outside_picture,  ///< its light lands beside the film
    blocked,          ///< it lies in front of the lens, which lets none of its light through to the film's plane
    behind,           ///< it lies behind the lens, or in it
    bad_input,        ///< a coordinate is not finite
};

/// Columns and rows count from the upper left corner of the picture: the middle of the first pixel is (0.5, 0.5).
struct ProjectedPoint {
    Vec2<double> pixel;  ///< NaN where no line is known that goes there
    ProjectionStatus status;
};

/// A line from the lens into the scene, metres.
struct PixelRay {
    Vec3d origin_m, direction;  ///< NaN for a pixel without light
    double light = 0;           ///< the pixel's irradiance for an even field, over that in the middle of the film
};

/// Takes points of the scene to a camera's picture, and pixels to lines in the scene. If the camera moves, each row of
/// pixels is seen from the camera's place in the middle of the row's exposure.
class Projection {
public:
    Projection(const Camera& camera, std::shared_ptr<const LinesOfSight> lines);

    ProjectedPoint pixel_of(Vec3d point_m) const;

    PixelRay ray_of(Vec2<double> pixel) const;

private:
    static constexpr int kMostTurns = 20;
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    static constexpr Vec2<double> kNowhere = {kNone, kNone};
    static constexpr Vec3d kNowhere3 = {kNone, kNone, kNone};

    int row_of(double y) const { return static_cast<int>(std::clamp(y, 0.0, static_cast<double>(film_.height - 1))); }

    ProjectedPoint seen_from(const Affine<double>& place, Vec3d point_m) const;

    Film film_;
    std::shared_ptr<const LinesOfSight> lines_;
    std::vector<Affine<double>> places_;  ///< of the rows of pixels; one, if it is the same for all
};

}  // namespace REALCAM_NAMESPACE
