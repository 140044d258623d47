#pragma once
#include <vector>

#include "../prescription/lens_system.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// Point on the aperture stop, in units of the radius of the stop's bounding circle.
struct PupilPoint {
    double x, y;
    double weight;  ///< fraction of the stop's area that the point represents, up to a factor common to the pattern
    int cell = -1;  ///< index of the point's cell in square_grid, row by row from the lowest y; -1: other patterns
};

// Sampling patterns of the stop, for integrals over it. They throw Cancelled if `loop` is cancelled.

/// Centres of the cells of an n x n grid over the circle; centres outside the circle are left out.
std::vector<PupilPoint> square_grid(int n, const RayLoop& loop = {});

/// A centre point and n rings of 6, 12, 18 ... points at equal distances, all of equal weight, as in OpticStudio's
/// standard spot diagram. The outermost ring lies on the edge.
std::vector<PupilPoint> hexapolar(int n, const RayLoop& loop = {});

/// n rings at the Gauss-Legendre nodes in the squared radius, 4 n points each: integrals over a full round pupil are
/// exact for polynomials up to degree 4 n - 2 (G. W. Forbes, "Optical system assessment for design: numerical ray
/// tracing in the Gaussian pupil", J. Opt. Soc. Am. A 5, 1943, 1988).
std::vector<PupilPoint> gauss_rings(int n, const RayLoop& loop = {});

/// Radius of the circle around the stop's opening, mm: the unit of PupilPoint. For an iris, the circle passes through
/// the corners between its blades.
double stop_bounding_radius(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
