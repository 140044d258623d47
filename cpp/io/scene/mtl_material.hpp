#pragma once
#include <optional>

#include "../../math/vec3.hpp"
#include "file_texture.hpp"

namespace realcam::io {

/// Material of an MTL file (Alias|Wavefront, File Formats 4.2, 1995), with later additions: Ke, norm, and the
/// statements for physically based rendering, which begin with P. Members have the names of the format.
struct MtlMaterial {
    Vec3f Ka = {0, 0, 0};           ///< ambient; not needed by a path tracer
    Vec3f Kd = {0.6f, 0.6f, 0.6f};  ///< the format has no default; many viewers use this one
    Vec3f Ks = {0, 0, 0};
    Vec3f Ke = {0, 0, 0};
    Vec3f Tf = {1, 1, 1};     ///< transmission filter
    float Ns = 0;             ///< Phong exponent
    std::optional<float> Ni;  ///< index of refraction, 0.001 to 10
    float d = 1;              ///< 0..1, 1 is opaque; Tr is 1 - d

    /// Illumination model, 0 to 10. The format has no default. Model 2 has highlights, and model 1 only colour and
    /// ambient; so it is 2 for a material that has Ks, and 1 for others.
    int illum = 1;

    std::optional<float> Pr, Pm;  ///< roughness and metallic, 0..1; either one selects that model
    float Pc = 0, Pcr = 0;  ///< clearcoat and its roughness, 0..1

    FileTexture map_Kd, map_Ks, map_Ke;  ///< colours that multiply Kd, Ks and Ke
    FileTexture map_d, map_Ns, map_Pr, map_Pm;  ///< numbers that multiply d, Ns, Pr and Pm
    FileTexture bump;  ///< heights, bright is high
    float bm = 1;  ///< factor of those heights
    FileTexture norm;  ///< normals in tangent space
};

}  // namespace realcam::io
