#include "gltf_material.hpp"

namespace realcam::io {

namespace {

/// See GltfMaterial::textures. Both types are const, or neither.
template <class Material, class Texture>
std::vector<Texture*> textures_of(Material& m) {
    auto& gloss = m.specular_glossiness;  // replaces the metallic-roughness model if present
    std::vector<Texture*> all = {gloss ? &gloss->diffuse_texture : &m.base_color_texture,
                                 gloss ? &gloss->specular_glossiness_texture : &m.metallic_roughness_texture,
                                 &m.normal_texture,
                                 &m.emissive_texture,
                                 &m.transmission.texture,
                                 &m.volume.thickness_texture,
                                 &m.clearcoat.texture,
                                 &m.clearcoat.roughness_texture,
                                 &m.clearcoat.normal_texture,
                                 &m.specular.texture,
                                 &m.specular.color_texture};
    std::erase_if(all, [](const FileTexture* texture) { return !*texture; });
    return all;
}

}  // namespace

std::vector<const FileTexture*> GltfMaterial::textures() const {
    return textures_of<const GltfMaterial, const FileTexture>(*this);
}

std::vector<FileTexture*> GltfMaterial::textures() {
    return textures_of<GltfMaterial, FileTexture>(*this);
}

}  // namespace realcam::io
