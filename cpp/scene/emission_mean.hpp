#pragma once
#include <vector>

#include "../checkpoint.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Mean brightness of emission maps, by which the light tree chooses emitters (build_light_tree.hpp). Host only.

/// Returns, for each emitter of a mesh, the mean factor by which emission map and vertex colours multiply its
/// luminance; 1 without them. Samples the triangle and blends in the mean of the whole map, so that emission that the
/// samples miss keeps a non-zero probability: 0 only if the map is black.
std::vector<float> emission_means(const MeshView& mesh, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
