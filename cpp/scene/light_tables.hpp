#pragma once
#include <vector>

#include "../checkpoint.hpp"
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

// The probabilities by which the pixels of an environment are chosen. Most of it goes by their power. A share is even,
// because a light that is 1e8 times dimmer than another is all the light where the other does not reach.

inline constexpr double kEvenShare = 0.125;  ///< its price: where power is the best choice, 1/7 more variance

/// `weights` by their sum, less kEvenShare; that share by `even_weights`, which are 0 where `weights` are.
std::vector<double> mixed(std::vector<double> weights, const std::vector<double>& even_weights);

struct EnvironmentTables {
    std::vector<float> marginal_cdf, conditional_cdf;  ///< empty for a constant environment
    float mean_luminance = 0;                          ///< over all directions
};

/// For choosing the pixels of an image by their light and, for the even share, by their solid angle where they have
/// any.
EnvironmentTables environment_tables(const Environment& e, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
