#pragma once
#include <assimp/Importer.hpp>
#include <string>

namespace realcam::io {

/// assimp takes no ".5" for a number: it leaves out the vertex, and the indices that follow mean others. If the OBJ
/// `path` has such numbers, the importer is given the text with "0.5" in their place.
void mend_obj_numbers(Assimp::Importer& importer, const std::string& path);

}  // namespace realcam::io
