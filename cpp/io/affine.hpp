#pragma once
// The transform of a node, in double precision: assimp's own matrices are float, and their product would lose the
// millimetres of an object a thousand kilometres away.

#include <assimp/matrix4x4.h>

#include "../math/affine.hpp"

namespace realcam::io {

inline Affine<double> affine_from(const aiMatrix4x4& m) {
    return {{double(m.a1), double(m.b1), double(m.c1)},
            {double(m.a2), double(m.b2), double(m.c2)},
            {double(m.a3), double(m.b3), double(m.c3)},
            {double(m.a4), double(m.b4), double(m.c4)}};
}

}  // namespace realcam::io
