#pragma once
#include <array>
#include <vector>

#include "../pupil/bundle_quadrature.hpp"
#include "point_bundle.hpp"

namespace REALCAM_NAMESPACE {

/// A ray of a bundle, with the fraction of the light that it represents.
struct BundleRay {
    PointBundle::Entry entry;  ///< on the entry plane, mm
    double energy;  ///< fraction of the energy of all rays
    Vec2<double> at;  ///< on the film, mm from the chief ray
    Vec3d direction;  ///< unit, behind the lens
    WaveRay wave;
    double amplitude;  ///< root of the energy per area of slopes, times a common factor
};

/// Segment of the edge of what passes: its two end points.
struct EdgePiece {
    std::array<PointBundle::Entry, 2> entry;
    std::array<Vec2<double>, 2> slope;
};

/// Ray bundle of one object point at one wavelength, with the edge of what passes and the foci about the chief ray.
struct TracedBundle {
    std::vector<BundleRay> rays;
    std::vector<EdgePiece> edge;
    double tangential_focus, sagittal_focus;  ///< foci of rays close to the chief ray, mm behind the film plane
};

/// Traces rays at Gauss's nodes on radial scan lines over what passes. If a bundle is its own mirror image, the second
/// half of the rays are the mirror images of the first.
TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
