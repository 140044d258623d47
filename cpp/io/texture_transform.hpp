#pragma once
#include <cmath>

#include "../math/vec3.hpp"

namespace realcam::io {

/// glTF's KHR_texture_transform, to be applied to the coordinates of vertices. Identity by default.
class TextureTransform {
public:
    TextureTransform() = default;
    /// As the extension has them, with v downwards: scaled first, then turned, then moved.
    TextureTransform(double scale_u, double scale_v, double rotation, double offset_u, double offset_v) {
        const double c = std::cos(rotation), s = std::sin(rotation);
        from_u_ = {c * scale_u, -s * scale_u, 0};
        from_v_ = {s * scale_v, c * scale_v, 0};
        offset_ = {offset_u, offset_v, 0};
    }

    /// v upwards; the extension itself has it downwards, and turns against the clock as seen on the picture.
    Vec2f operator()(float u, float v) const {
        const Vec3d out = double(u) * from_u_ + (1 - double(v)) * from_v_ + offset_;
        return {static_cast<float>(out.x), static_cast<float>(1 - out.y)};
    }

private:
    Vec3d from_u_ = {1, 0, 0}, from_v_ = {0, 1, 0}, offset_ = {0, 0, 0};
};

}  // namespace realcam::io
