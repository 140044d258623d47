#pragma once
// Small valid scene files, from which mutations start; they use every part of their formats that realcam reads.

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace realcam::fuzz {

inline std::string obj_seed() {
    return "\xef\xbb\xbf# seed\nmtllib seed.mtl\nv -1 -1 0\nv 1 -1 0 0.5 0.5 0.5\nv 1 1 0\nv -1 1 0.2\nv 0 .25 0 2\nv "
           "2 2 1e-3\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvn 0 0 1\nvn 0 0.6 0.8\ng a\nusemtl x\ns 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
           "o b\ns off\nusemtl y\nf -4//-1 -2//-1 -1//-2\nusemtl z\ns 2\nf 1 3 \\\n 4\nf 1 2 5 3 4\nf 4 3 2 1 5\ng a "
           "b\nusemtl "
           "none\n"
           "f 1/1 2/2 3/3\r\nl 1 2\np 1\nf 1 2\n";
}

inline std::string mtl_seed() {
    return "newmtl x\nKd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nKa 1 1 1\nNs 50\nmap_Kd -s 1 1 1 -o 0.5 -clamp on "
           "seed.png\nnewmtl y\n"
           "Ke 1 2 3\nmap_Ke seed.png\nd 0.5\nTr 0.25\nillum 2\nNi 1.5\nnewmtl z\nKd 1 0 0\nmap_Ks -s 1 1 1 seed.png\n"
           "map_Bump -bm 0.3 seed.png\nTf 1 1 1\nd -halo 0.5\nbump other.png\nnorm seed.png\nKd spectral file.rfl 1\n"
           "newmtl w\nillum 7\nPr 0.5\nPm 1\nPc 0.5\nPcr 0.1\nmap_Pr seed.png\nmap_Pm -mm 0 1 seed.png\n"
           "map_d -imfchan r -texres 64 seed.png\nmap_Ns -t 1 1 1 seed.png\nPs 0.5\naniso 1\nrefl -type sphere "
           "seed.png\n"
           "disp seed.png\nTr 0.5\n";
}

inline std::string ply_ascii_seed() {
    return "ply\nformat ascii 1.0\ncomment TextureFile seed.png\ncomment TextureFile other.png\nobj_info nothing\n"
           "element vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty float nx\nproperty float "
           "ny\nproperty float nz\nproperty float s\nproperty float t\nproperty uchar red\nproperty uchar "
           "green\nproperty uchar blue\nproperty uchar alpha\nelement face 2\nproperty list uchar int "
           "vertex_indices\nproperty list uchar float texcoord\nproperty list uchar float other\nproperty float "
           "red\nproperty float green\nproperty float blue\nproperty int texnumber\nelement tristrips 1\nproperty list "
           "int int vertex_indices\nelement edge 1\nproperty int a\nend_header\n"
           "-1 -1 0 0 0 1 0 0 255 0 0 255\n1 -1 0 0 0 1 1 0 255 9 8 7\n0 1 0.5 0 0 1 1 1 0 0 0 0\n0 2 1e-3 0 0 1 0.5 0 "
           "1 "
           "2 3 4\n3 0 1 2 6 0 0 1 0 1 1 0 1 0.5 0 1\n4 0 1 2 3 0 2 0.5 0.25 0 1 2 -1\n7 0 1 2 3 -1 0 1\n7\n";
}

/// Numbers as a binary file has them.
class Packed {
public:
    explicit Packed(bool big_endian = false) : big_endian_(big_endian) {}

    template <class T>
    Packed& add(std::initializer_list<T> values) {
        for (const T value : values) {
            char raw[sizeof(T)];
            std::memcpy(raw, &value, sizeof(T));
            for (std::size_t i = 0; i < sizeof(T); ++i) bytes += raw[big_endian_ ? sizeof(T) - 1 - i : i];
        }
        return *this;
    }

    std::string bytes;

private:
    bool big_endian_;
};

inline std::string ply_binary_seed(bool big_endian) {
    Packed data(big_endian);
    data.add({-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, 0.f, 1.f, .5f, 0.f, 2.f, 1.f});
    data.add<std::uint8_t>({3}).add<std::int32_t>({0, 1, 2}).add<std::uint8_t>({4}).add<std::int32_t>({0, 1, 2, 3});
    return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
           "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
           "property list uchar int vertex_index\nend_header\n" +
           data.bytes;
}

inline std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return out;
}

/// The buffer of the glTF seed: positions, normals, texture coordinates, joints, weights, indices, sparse indices and
/// values, inverse bind matrices, bytes that are no valid picture, and times.
inline std::string gltf_buffer() {
    Packed data;
    data.add({-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, 1.f, 1.f, 0.f, -1.f, 1.f, 0.f});                    // at 0
    data.add({0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 0.f, .6f, .8f, 0.f, 0.f, 1.f});                        // 48
    data.add({0.f, 0.f, 1.f, 0.f, 1.f, 1.f, 0.f, 1.f});                                            // 96
    data.add<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0});                      // 128
    data.add<std::uint8_t>({128, 127, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 100, 155, 0, 0});          // 144
    data.add<std::uint16_t>({0, 1, 2, 0, 2, 3});                                                   // 160
    data.add<std::uint16_t>({1, 3}).add({2.f, -1.f, 0.f, -1.f, 2.f, 0.f});                         // 172, 176
    for (int j = 0; j < 2; ++j)
        data.add({1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, -1.f, 1.f});
    data.bytes += "PICTURE!";                                                                      // 328
    data.add({0.f, .5f, 1.f, 2.f});                                                                // 336
    return data.bytes;
}

/// JSON of the glTF seed. `uri`: the buffer's uri property with its leading comma (",\"uri\":\"...\""); empty for a
/// GLB.
inline std::string gltf_seed(const std::string& uri) {
    return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual","KHR_materials_sheen"],"extensionsRequired":["KHR_texture_transform"],
"scene":0,"scenes":[{"name":"main","nodes":[0,4,6]},{"nodes":[4,6]}],
"nodes":[{"name":"root","children":[1,2,3],"translation":[0,1,0],"rotation":[0,0,0.7071,0.7071],"scale":[1,2,-1]},
{"name":"car","mesh":0},{"name":"car","mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,2,1,1],"weights":[0.5],
"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0,"SCALE":1,"ROTATION":4}}}},
{"extensions":{"KHR_lights_punctual":{"light":0}}},{"mesh":2,"skin":0,"children":[5]},
{"name":"bone","translation":[0,0,1],"camera":1,"extensions":{"KHR_lights_punctual":{"light":1}}},{"name":"sun","children":[],"camera":0}],
"meshes":[{"name":"plain","primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":5,"material":0},
{"attributes":{"POSITION":6,"COLOR_0":3},"mode":5}]},
{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_1":2},"indices":5,"mode":6,"material":1,"targets":[{"POSITION":1,"NORMAL":1}]}],"weights":[0.25]},
{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"JOINTS_0":3,"WEIGHTS_0":4},"indices":5,"material":2}]}],
"skins":[{"joints":[5,6],"inverseBindMatrices":7,"skeleton":5}],
"materials":[{"name":"m","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.5],"metallicFactor":0.5,"roughnessFactor":0.4,
"baseColorTexture":{"index":0,"texCoord":0,"extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.5,"scale":[0.5,2]}}},
"metallicRoughnessTexture":{"index":1}},"emissiveFactor":[1,1,0],"emissiveTexture":{"index":1},"alphaMode":"BLEND","doubleSided":true,
"normalTexture":{"index":0,"scale":2},"occlusionTexture":{"index":1,"strength":0.5,"texCoord":1},"alphaCutoff":0.25,
"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":5},"KHR_materials_ior":{"ior":1.33},"KHR_materials_unlit":{},
"KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}},
"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":0.5,"attenuationColor":[0.5,1,1],"thicknessTexture":{"index":0}},
"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatRoughnessFactor":0.1,"clearcoatNormalTexture":{"index":0,"scale":1}},
"KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[2,1,1],"specularTexture":{"index":1}},"KHR_materials_sheen":{}}},
{"pbrMetallicRoughness":{"baseColorTexture":{"index":1,"texCoord":1}}},
{"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":[1,1,1,1],"specularFactor":[0.1,0.2,0.3],"glossinessFactor":0.5,
"diffuseTexture":{"index":0},"specularGlossinessTexture":{"index":1}}}}],
"textures":[{"source":0,"sampler":0},{"source":1}],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728,"minFilter":9987}],
"images":[{"bufferView":8,"mimeType":"image/png"},{"uri":"seed.png"},{"uri":"data:image/png;base64,iVBORw0KGgo="}],
"cameras":[{"name":"eye","type":"perspective","perspective":{"yfov":1,"znear":0.1}},{"type":"orthographic"}],
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},{"sampler":1,"target":{"node":1,"path":"rotation"}},
{"sampler":2,"target":{"node":5,"path":"rotation"}},{"sampler":3,"target":{"node":2,"path":"weights"}}],
"samplers":[{"input":8,"output":0},{"input":8,"output":4,"interpolation":"STEP"},{"input":8,"output":4},{"input":8,"output":8}]}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","color":[1,0.5,0.25],"intensity":40},{"type":"spot","spot":{"innerConeAngle":0.1,"outerConeAngle":0.5}},{"type":"directional"}]}},
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]},
{"bufferView":0,"byteOffset":48,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":2,"componentType":5121,"count":4,"type":"VEC4"},{"bufferView":3,"componentType":5121,"normalized":true,"count":4,"type":"VEC4"},
{"bufferView":4,"componentType":5123,"count":6,"type":"SCALAR"},
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,"indices":{"bufferView":5,"componentType":5123},"values":{"bufferView":6}}},
{"bufferView":7,"componentType":5126,"count":2,"type":"MAT4"},{"bufferView":9,"componentType":5126,"count":4,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":96,"byteStride":12},{"buffer":0,"byteOffset":96,"byteLength":32},{"buffer":0,"byteOffset":128,"byteLength":16},
{"buffer":0,"byteOffset":144,"byteLength":16},{"buffer":0,"byteOffset":160,"byteLength":12},{"buffer":0,"byteOffset":172,"byteLength":4},
{"buffer":0,"byteOffset":176,"byteLength":24},{"buffer":0,"byteOffset":200,"byteLength":128},{"buffer":0,"byteOffset":328,"byteLength":8},{"buffer":0,"byteOffset":336,"byteLength":16}],
"buffers":[{"byteLength":352)" +
           uri + "}]}";
}

inline std::string gltf_seed() {
    return gltf_seed(R"(,"uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer()) + '"');
}

inline std::string glb_of(const std::string& json, const std::string& binary) {
    Packed glb;
    const auto size = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
    glb.bytes = "glTF";
    glb.add<std::uint32_t>({2, size(28 + json.size() + binary.size()), size(json.size())});
    glb.bytes += "JSON" + json;
    glb.add<std::uint32_t>({size(binary.size())});
    return glb.bytes + std::string("BIN\0", 4) + binary;
}

}  // namespace realcam::fuzz
