#pragma once
#include <vector>

#include "../prescription/lens_system.hpp"
#include "../trace/ray_loop.hpp"

namespace REALCAM_NAMESPACE {

/// A place on the aperture stop, as a share of the radius of the circle that holds its opening.
struct PupilPoint {
    double x, y;
    double weight;  ///< share of the stop's area for which it stands, up to a common factor
    int cell = -1;  ///< of a square grid: its number, row by row from the lowest y
};

// Points of the stop, for integrals over it. Each throws what `loop` throws to stop it.

/// Midpoints of the cells of an n x n grid over the circle, those outside of it left out.
std::vector<PupilPoint> square_grid(int n, const RayLoop& loop = {});

/// A middle point and n rings of 6, 12, 18 ... points at equal distances, all of one weight: as OpticStudio's standard
/// spot diagram. The outermost ring lies on the edge.
std::vector<PupilPoint> hexapolar(int n, const RayLoop& loop = {});

/// n rings at the nodes of Gauss and Legendre in the squared radius, 4 n points each: integrals over a full round
/// pupil are exact for polynomials up to degree 4 n - 2 (G. W. Forbes, "Optical system assessment for design:
/// numerical ray tracing in the Gaussian pupil", J. Opt. Soc. Am. A 5, 1943, 1988).
std::vector<PupilPoint> gauss_rings(int n, const RayLoop& loop = {});

/// Radius of the smallest circle that holds the opening of the stop, mm: places on the stop are shares of it.
double stop_reach(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
