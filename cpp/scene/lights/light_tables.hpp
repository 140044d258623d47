#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "../scene.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Mean brightness of emission maps, by which the light tree chooses emitters (build_light_tree.hpp). Host only.

/// Returns, for each emitter of a mesh, the mean factor by which emission map and vertex colours multiply its
/// luminance; 1 without them. Samples the triangle and blends in the mean of the whole map, so that emission that the
/// samples miss keeps a non-zero probability: 0 only if the map is black.
std::vector<float> emission_means(const MeshView& mesh, Checkpoint& checkpoint);

// Sampling probabilities of an environment map's pixels: mostly in proportion to power, blended with a uniform
// distribution, because a light that is 1e8 times dimmer than another is all the light that reaches points where the
// brighter one is occluded.

/// Weight of the uniform distribution in the mixture. It costs 1/7 more variance if sampling by power is optimal.
inline constexpr double kUniformWeight = 0.125;

/// Defensive mixture: (1 - kUniformWeight) of the normalised `weights` plus kUniformWeight of the normalised
/// `uniform_weights`, which must be 0 for elements with a weight of 0. Returns `weights` if all are 0.
std::vector<double> defensive_mixture(std::vector<double> weights, const std::vector<double>& uniform_weights);

/// Arrays of an EnvironmentView.
struct EnvironmentTables {
    std::vector<float> marginal_cdf, conditional_cdf;  ///< see EnvironmentView; empty for a constant environment
    float mean_luminance = 0;                          ///< cd/m^2, over all directions
};

/// Returns the tables for sampling an environment map: pixels by power and, for the uniform part, by solid angle if
/// they are not black. Throws Cancelled if `checkpoint` does.
EnvironmentTables environment_tables(const Environment& e, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
