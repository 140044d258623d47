#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "../../io/scene/decoded_image.hpp"
#include "../../scene/scene.hpp"
#include "../bindings.hpp"

namespace realcam::bindings {

/// Self-contained material for Python, with its name in the scene file and its textures.
struct PythonMaterial {
    std::string name;  ///< empty: the material has no name
    Material values;  ///< texture indices are unset
    /// Textures in the order of kMaterialTextures; null: no texture.
    std::array<std::shared_ptr<const Texture>, kMaterialTextures.size()> textures;
};

/// Throws InputError if a texture is invalid or a texture index is set. Other values are checked together with the
/// scene that receives the material.
void validate(const PythonMaterial& material);

/// Returns a copy of a scene's material. Its textures are shared with the scene, which they keep alive.
PythonMaterial material_of(const std::shared_ptr<const Scene>& scene, std::size_t index);

/// Replaces the material at an index, or appends it. A replaced material keeps its name if it has one. Removes textures
/// that are no longer used.
void set_material(Scene& scene, std::size_t index, const PythonMaterial& material);

/// Converts pixels to a texture: (H, W) or (H, W, 1) grey, (H, W, 3) RGB or (H, W, 4) RGBA, as integers 0 to 255 or
/// floats 0 to 1. An opacity texture without a fourth channel uses the mean of its channels. Throws InputError for any
/// other array.
std::shared_ptr<const Texture> texture_from(const py::object& pixels, io::TextureUse use);

}  // namespace realcam::bindings
