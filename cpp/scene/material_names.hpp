#pragma once
#include <string>
#include <vector>

#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// Returns a unique name for each material: that of the file, "material 3" for one without a name, "wood.2" for the
/// second "wood".
std::vector<std::string> material_names(const Scene& scene);

}  // namespace REALCAM_NAMESPACE
