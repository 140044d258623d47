#pragma once
#include <vector>

#include "../checkpoint.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

// How bright the emission maps of a mesh are, by which its lights are chosen (build_light_tree.hpp). On the host.

/// For each of a mesh's emitters, what its map and the vertices' colours make of its luminance: 1 without them. Samples
/// over the triangle, and a part of the whole map's mean, so that what they miss is still a light: 0 only where the map
/// is black.
std::vector<float> emission_means(const MeshView& mesh, Checkpoint& checkpoint);

}  // namespace REALCAM_NAMESPACE
