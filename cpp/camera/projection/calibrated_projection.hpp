#pragma once
#include <memory>
#include <optional>

#include "../models/bundle_motions.hpp"
#include "projection.hpp"

namespace REALCAM_NAMESPACE {

/// Projection rays of a calibrated camera: those of its lens, moved with the bundles of their film points.
class CalibratedProjection : public ProjectionRays {
public:
    /// `lens`: projection rays of the lens without the calibration.
    CalibratedProjection(std::shared_ptr<const ProjectionRays> lens, BundleMotions motions);

    std::optional<FilmProjection> ray(Vec2<double> film) const override;
    std::optional<Vec2<double>> project(Vec3d point) const override;
    bool is_in_front(Vec3d point) const override { return lens_->is_in_front(point); }
    bool ends_in_film() const override { return lens_->ends_in_film() || motions_.view().defined; }

private:
    std::shared_ptr<const ProjectionRays> lens_;
    BundleMotions motions_;
};

}  // namespace REALCAM_NAMESPACE
