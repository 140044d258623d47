#pragma once
#include "../../math/gauss_legendre.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

namespace best_focus_detail {

/// Gauss-Legendre nodes and weights on [0, 1].
template <int N>
struct GaussRule {
    double node[N], weight[N];

    GaussRule() {
        for (int k = 0; k < N; ++k) {
            const GaussNode rule = gauss_node(N, k);
            node[k] = rule.node;
            weight[k] = rule.weight;
        }
    }
};

}  // namespace best_focus_detail

/// Returns the distance from the last vertex to the film plane on which the real rays from an axial point make the
/// smallest RMS spot, mm. `object_distance`: from the point to the front vertex, mm, may be infinite. The iris is
/// treated as round. Returns NaN if no ray passes, or for an afocal lens with the object at infinity. The lens must be
/// rotationally symmetric.
///
/// The rays fill the aperture uniformly. Behind the lens they are straight lines x(z) = x0 + m z, so the plane of the
/// smallest mean square is z = -integral(x0 m) / integral(m^2).
double best_focus_distance(LensSystem lens, double wavelength_nm, double object_distance);

}  // namespace REALCAM_NAMESPACE
