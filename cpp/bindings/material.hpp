#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "../io/scene/decoded_image.hpp"
#include "../scene/material_names.hpp"
#include "../scene/scene.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

/// A material by itself, as Python has it: with the name that it bears in its file, and its textures.
struct PythonMaterial {
    std::string name;  ///< empty: none
    Material values;   ///< without the numbers of textures
    /// In the order of kMaterialTextures; null: none.
    std::array<std::shared_ptr<const Texture>, kMaterialTextures.size()> textures;
};

PythonMaterial material_of(const std::shared_ptr<const Scene>& scene, std::size_t index);

/// Puts a material in place of one, or at the end. The place keeps its name, if it has one.
void set_material(Scene& scene, std::size_t index, const PythonMaterial& material);

/// Pixels as users have them: (H, W) or (H, W, 1) grey, (H, W, 3) or (H, W, 4), as codes 0 to 255 or shares 0 to 1 of
/// them. For opacity, without a fourth channel: their mean. Throws InputError for all else.
std::shared_ptr<const Texture> texture_from(const py::object& pixels, io::TextureUse use);

}  // namespace realcam::bindings
