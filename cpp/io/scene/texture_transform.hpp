#pragma once
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "../../math/vec3.hpp"
#include "../../scene/material.hpp"

namespace realcam::io {

/// Affine map from a vertex's texture coordinates to those in a picture. Identity by default.
class TextureTransform {
public:
    TextureTransform() = default;
    /// Transform of glTF's KHR_texture_transform, with v downwards: scale, then rotation (radians), then offset.
    TextureTransform(double scale_u, double scale_v, double rotation, double offset_u, double offset_v) {
        const double c = std::cos(rotation), s = std::sin(rotation);
        from_u_ = {c * scale_u, -s * scale_u, 0};
        from_v_ = {s * scale_v, c * scale_v, 0};
        offset_ = {offset_u, offset_v, 0};
    }
    /// Transform of MTL's options -s and -o, with v upwards: (scale_u u + offset_u, scale_v v + offset_v).
    static TextureTransform of_mtl(double scale_u, double scale_v, double offset_u, double offset_v) {
        return {scale_u, scale_v, 0, offset_u, 1 - scale_v - offset_v};
    }

    /// Transforms coordinates with v upwards; the extension itself has v downwards, and rotates counter-clockwise as
    /// seen on the picture.
    Vec2f operator()(float u, float v) const {
        const Vec3d out = double(u) * from_u_ + (1 - double(v)) * from_v_ + offset_;
        return {static_cast<float>(out.x), static_cast<float>(1 - out.y)};
    }

    /// Returns the transform for the renderer, with the index of the texture in the scene.
    TextureReference reference(std::int32_t texture) const {
        const auto f = [](double v) { return static_cast<float>(v); };
        return {texture,
                {f(from_u_.x), f(-from_v_.x), f(from_v_.x + offset_.x)},
                {f(-from_u_.y), f(from_v_.y), f(1 - from_v_.y - offset_.y)}};
    }

    /// True if the renderer's floats can represent the transform.
    bool is_finite() const {
        const TextureReference r = reference(0);
        for (const float v : {r.to_u.x, r.to_u.y, r.to_u.z, r.to_v.x, r.to_v.y, r.to_v.z})
            if (!std::isfinite(v)) return false;
        return true;
    }

    bool operator==(const TextureTransform& b) const {
        return from_u_ == b.from_u_ && from_v_ == b.from_v_ && offset_ == b.offset_;
    }

private:
    /// The coordinates, with v downwards, are u from_u_ + v from_v_ + offset_; z is not used.
    Vec3d from_u_ = {1, 0, 0}, from_v_ = {0, 1, 0}, offset_ = {0, 0, 0};
};

/// Texture of a material property.
struct FileTexture {
    std::int32_t picture = -1;  ///< index in FileScene::pictures, or -1
    std::uint32_t uv_set = 0;  ///< 0: FileVertices::uvs; 1: second_uvs
    TextureTransform transform;
    TextureSampler sampler = {};

    /// Returns the reference for the renderer; `texture`: index of the picture in the scene's textures.
    TextureReference reference(std::int32_t texture) const {
        TextureReference out = transform.reference(texture);
        out.sampler = sampler;
        out.uv_set = static_cast<std::int8_t>(uv_set);
        return out;
    }
    /// True if both textures have the same transform and sampler.
    bool has_same_mapping(const FileTexture& b) const { return transform == b.transform && sampler == b.sampler; }

    /// True if there is a texture.
    explicit operator bool() const { return picture >= 0; }
};

}  // namespace realcam::io
