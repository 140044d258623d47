#pragma once
#include <cmath>
#include <cstddef>

#include "../math/vec3.hpp"
#include "json.hpp"

namespace realcam::io {

/// glTF's KHR_texture_transform, to be applied to the coordinates of vertices.
class TextureTransform {
public:
    /// `texture_info`: the place in a material that names a texture; identity if it is null or has no such extension.
    explicit TextureTransform(const Json& texture_info) {
        const Json& json = texture_info["extensions"]["KHR_texture_transform"];
        const Json &offset = json["offset"], &scale = json["scale"];
        const double angle = json["rotation"].number(0), c = std::cos(angle), s = std::sin(angle);
        const double u = scale[std::size_t{0}].number(1), v = scale[1].number(1);
        from_u_ = {c * u, -s * u, 0};
        from_v_ = {s * v, c * v, 0};
        offset_ = {offset[std::size_t{0}].number(0), offset[1].number(0), 0};
    }

    /// v upwards; the extension itself has it downwards, and turns against the clock as seen on the picture.
    Vec2f operator()(float u, float v) const {
        const Vec3d out = double(u) * from_u_ + (1 - double(v)) * from_v_ + offset_;
        return {static_cast<float>(out.x), static_cast<float>(1 - out.y)};
    }

private:
    Vec3d from_u_, from_v_, offset_;
};

}  // namespace realcam::io
