#pragma once
#include <vector>

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

/// A shining triangle.
struct Lamp {
    Vec3d a, b, c;
    float radiance;
};

/// Adds lamps to a scene.
inline void add_lamps(Scene& scene, const std::vector<Lamp>& lamps) {
    for (const Lamp& lamp : lamps) {
        const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
        scene.positions_m.insert(scene.positions_m.end(), {lamp.a, lamp.b, lamp.c});
        scene.triangles.push_back({{first, first + 1, first + 2}, static_cast<std::uint32_t>(scene.materials.size())});
        Material material;
        material.emission = {lamp.radiance, lamp.radiance, lamp.radiance};
        scene.materials.push_back(material);
    }
}

}  // namespace realcam::test
