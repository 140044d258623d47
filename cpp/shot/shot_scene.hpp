#pragma once
#include "../checkpoint.hpp"
#include "../scene/assembly.hpp"
#include "scene_request.hpp"

namespace realcam::shot {

/// Adds the objects, materials and lights of a shot file to a scene. A material replaces all materials of its name, in
/// static geometry and objects. Throws InputError, SceneFileError, ImageFileError, and Cancelled.
Assembly with_additions(Assembly scene, const SceneRequest& request, const PictureReaders& readers,
                        const KeepGoing& keep_going = {});

/// Reads a picture file as a texture. `use`: how its values are interpreted. Throws InputError if it cannot be read.
Texture read_texture(const std::string& path, io::TextureUse use, const PictureReaders& readers);

}  // namespace realcam::shot
