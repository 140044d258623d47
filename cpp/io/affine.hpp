#pragma once
// The transform of a node, in double precision: assimp's own matrices are float, and their product would lose the
// millimetres of an object a thousand kilometres away.

#include <assimp/matrix4x4.h>

#include "../math/vec3.hpp"

namespace realcam::io {

struct Affine {
    Vec3d x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, origin = {0, 0, 0};

    Affine() = default;
    explicit Affine(const aiMatrix4x4& m)
        : x{double(m.a1), double(m.b1), double(m.c1)},
          y{double(m.a2), double(m.b2), double(m.c2)},
          z{double(m.a3), double(m.b3), double(m.c3)},
          origin{double(m.a4), double(m.b4), double(m.c4)} {}

    Vec3d direction(Vec3d d) const { return d.x * x + d.y * y + d.z * z; }
    Vec3d point(Vec3d p) const { return direction(p) + origin; }
    double determinant() const { return dot(x, cross(y, z)); }

    /// Not unit. The cofactors are the inverse transpose times the determinant, and exist where that one does not.
    Vec3d normal(Vec3d n) const {
        const Vec3d m = n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y);
        return determinant() < 0 ? -m : m;
    }

    friend Affine operator*(const Affine& a, const Affine& b) {
        Affine c;
        c.x = a.direction(b.x);
        c.y = a.direction(b.y);
        c.z = a.direction(b.z);
        c.origin = a.point(b.origin);
        return c;
    }
};

}  // namespace realcam::io
