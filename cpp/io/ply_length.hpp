#pragma once
#include <string>

namespace realcam::io {

/// Throws SceneFileError if a PLY is shorter than its header promises; assimp would repeat the last element that is
/// there. A header that it cannot follow passes: assimp has its own say.
void check_ply_is_whole(const std::string& path);

}  // namespace realcam::io
