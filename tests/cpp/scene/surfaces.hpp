#pragma once
// Surfaces of all kinds, for tests of how they scatter light.

#include <cmath>
#include <string>
#include <vector>

#include "scene/materials/make_bsdf.hpp"

namespace realcam::test {

struct NamedSurface {
    std::string name;
    Material material;
    bool is_front = true;  ///< seen from outside
};

/// The plane z = 0, with textures left out.
inline SurfacePoint point_on(const NamedSurface& surface) {
    const Material& m = surface.material;
    SurfacePoint point{};
    point.normal = point.geometric_normal = {0, 0, 1};
    point.material = &m;
    point.diffuse = m.diffuse;
    point.specular = m.specular;
    point.metallic = m.metallic;
    point.roughness = m.roughness;
    point.shininess = m.shininess;
    point.transmission = m.transmission;
    point.specular_weight = m.specular_weight;
    point.clearcoat = m.clearcoat;
    point.clearcoat_roughness = m.clearcoat_roughness;
    point.coat_normal = point.normal;
    point.is_front = surface.is_front;
    return point;
}

inline Vec3f eye_at(double cosine) {
    return static_cast<Vec3f>(Vec3d{-std::sqrt(1 - cosine * cosine), 0, cosine});
}

inline Bsdf bsdf_of(const NamedSurface& surface, Vec3f eye) {
    return make_bsdf<SceneKind::any>(point_on(surface), eye);
}

template <class Change>
NamedSurface phong(const std::string& name, Change&& change) {
    NamedSurface surface{name, {}};
    surface.material.diffuse = {0, 0, 0};
    change(surface.material);
    return surface;
}

/// White, with a dielectric's reflection, if `change` says nothing else.
template <class Change>
NamedSurface metallic_roughness(const std::string& name, Change&& change) {
    NamedSurface surface{name, {}};
    surface.material.model = MaterialModel::metallic_roughness;
    surface.material.diffuse = surface.material.specular = {1, 1, 1};
    change(surface.material);
    return surface;
}

/// Seen from inside.
inline NamedSurface from_behind(NamedSurface surface) {
    surface.name += ", from inside";
    surface.is_front = false;
    return surface;
}

inline std::string numbered(const std::string& name, float value) {
    std::string text = std::to_string(value);
    return name + ' ' + text.substr(0, 4);
}

}  // namespace realcam::test
