#include "scene_file.hpp"

#include <cmath>

#include "../error.hpp"
#include "scene_checks.hpp"
#include "scene_geometry.hpp"
#include "scene_import.hpp"
#include "scene_lights.hpp"
#include "scene_materials.hpp"
#include "scene_textures.hpp"

namespace realcam::io {

Scene read_scene(const std::string& path, const SceneFileOptions& options, const ImageReader& read_image) {
    if (!std::isfinite(options.scale) || !(options.scale > 0)) {
        throw InputError("scale must be a positive number of metres per unit of the file, not " +
                         std::to_string(options.scale));
    }
    const ImportedScene file(path);
    Scene scene;
    for (const std::string& complaint : file.complaints()) scene.warnings.push_back(path + ": " + complaint);
    SceneTextures textures(scene, file, path, read_image);
    read_materials(scene, file, textures, path);
    read_geometry(scene, file, path, options.scale);
    read_lights(scene, file, path, options.scale);
    validate(scene, path);
    return scene;
}

}  // namespace realcam::io
