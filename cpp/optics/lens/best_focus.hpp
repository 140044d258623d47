#pragma once
#include "../../math/gauss_legendre.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

namespace best_focus_detail {

/// Nodes and weights of Gauss and Legendre on [0, 1].
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

/// Last vertex to the film plane on which the real rays from an axial point make the smallest RMS spot, mm. The iris
/// counts as round.
///
/// The rays fill the aperture evenly; x(z) = x0 + m z is straight behind the lens, so the plane of the least mean
/// square is z = -integral(x0 m) / integral(m^2). NaN where no ray passes, and where an afocal lens looks at infinity.
double best_focus_distance(LensSystem lens, double wavelength_nm, double object_distance);

}  // namespace REALCAM_NAMESPACE
