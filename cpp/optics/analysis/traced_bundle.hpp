#pragma once
#include <array>
#include <vector>

#include "../pupil/bundle_quadrature.hpp"
#include "point_bundle.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of a bundle, with the share of the light that it stands for.
struct BundleRay {
    PointBundle::Entry entry;  ///< mm
    double energy;             ///< of all rays 1
    Vec2<double> at;           ///< on the film, mm from the chief ray
    Vec3d direction;           ///< unit, behind the lens
    WaveRay wave;
    double amplitude;  ///< root of the energy for each area of slopes, times a common factor
};

/// Two neighbouring places on the edge of what passes.
struct EdgePiece {
    std::array<PointBundle::Entry, 2> entry;
    std::array<Vec2<double>, 2> slope;
};

/// The light of one object point at one wavelength as rays, the edge of what passes, and the foci beside the chief ray.
struct TracedBundle {
    std::vector<BundleRay> rays;
    std::vector<EdgePiece> edge;
    double tangential_focus, sagittal_focus;  ///< of close rays, mm behind the film plane along the axis
};

/// Rays at Gauss's nodes on spokes over what passes. If a bundle is its own mirror image, the second half of the rays
/// are the mirror images of the first.
TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
