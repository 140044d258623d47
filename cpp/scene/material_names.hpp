#pragma once
#include <string>
#include <vector>

#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// A name for each material, all distinct: the file's, "material 3" for one without a name, "wood.2" for the second
/// "wood".
std::vector<std::string> material_names(const Scene& scene);

}  // namespace REALCAM_NAMESPACE
