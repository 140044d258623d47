#include "gltf_material.hpp"

namespace realcam::io {

std::vector<FileTexture> GltfMaterial::textures() const {
    const FileTexture& model =
        specular_glossiness ? specular_glossiness->specular_glossiness_texture : metallic_roughness_texture;
    std::vector<FileTexture> all = {colour_texture(),         model,
                                    normal_texture,           emissive_texture,
                                    transmission.texture,     volume.thickness_texture,
                                    clearcoat.texture,        clearcoat.roughness_texture,
                                    clearcoat.normal_texture, specular.texture,
                                    specular.color_texture};
    std::erase_if(all, [](const FileTexture& texture) { return !texture; });
    return all;
}

}  // namespace realcam::io
