#pragma once
#include "scene/scene.hpp"

namespace realcam::test {

/// One triangle, which a scene must have.
inline Scene bare_scene() {
    Scene scene;
    scene.positions_m = {{0, 0, 9}, {1, 0, 9}, {0, 1, 9}};
    scene.triangles = {{{0, 1, 2}, 0}};
    scene.materials = {Material{}};
    return scene;
}

}  // namespace realcam::test
