#pragma once
#include <optional>

#include "../../math/vec3.hpp"
#include "file_texture.hpp"

namespace realcam::io {

/// A material of an MTL (Alias|Wavefront, File Formats 4.2, 1995), with the statements that others have added since:
/// Ke, norm, and for physically based rendering those that begin with P. Members have the names of the format.
struct MtlMaterial {
    Vec3f Ka = {0, 0, 0};           ///< ambient: what a path tracer computes itself
    Vec3f Kd = {0.6f, 0.6f, 0.6f};  ///< the format names no default; many viewers have this one
    Vec3f Ks = {0, 0, 0};
    Vec3f Ke = {0, 0, 0};
    Vec3f Tf = {1, 1, 1};     ///< what passes of light that goes through
    float Ns = 0;             ///< Phong exponent
    std::optional<float> Ni;  ///< index of refraction, 0.001 to 10
    float d = 1;              ///< 0..1, 1 is opaque; Tr is 1 - d

    /// 0 to 10. The format names no default. It says of model 2 that highlights are on, and of model 1 that colour and
    /// ambient alone are; so it is 2 for a material that gives Ks, and 1 for others.
    int illum = 1;

    std::optional<float> Pr, Pm;  ///< roughness and metallic, 0..1; a material that gives one of them means that model
    float Pc = 0, Pcr = 0;  ///< clearcoat and its roughness, 0..1

    FileTexture map_Kd, map_Ks, map_Ke;  ///< colours, by which Kd, Ks and Ke are multiplied
    FileTexture map_d, map_Ns, map_Pr, map_Pm;  ///< numbers, by which d, Ns, Pr and Pm are multiplied
    FileTexture bump;  ///< heights, bright is high
    float bm = 1;  ///< by which those heights are multiplied
    FileTexture norm;  ///< normals in tangent space
};

}  // namespace realcam::io
