#pragma once
#include <cstddef>
#include <tuple>
#include <type_traits>

#include "../../optics/prescription/glass.hpp"
#include "../../scene/assembly.hpp"

namespace realcam::bindings {

// Access to all members of a struct as a tuple, for comparisons and pickles.

namespace members_detail {

/// Converts to any type, for counting an aggregate's members.
struct Anything {
    template <class T>
    operator T() const;
};

/// Number of initialisers of an aggregate, which is its number of members if none is a C array.
template <class T, class... Given>
consteval std::size_t count() {
    if constexpr (requires { T{Given{}..., Anything{}}; })
        return count<T, Given..., Anything>();
    else
        return sizeof...(Given);
}

}  // namespace members_detail

/// Returns a tuple of references to all members of an aggregate, in order. Structured bindings find the members, so
/// that members added later take part in comparisons and pickles.
template <class T>
auto members(T& x) {
    constexpr std::size_t n = members_detail::count<std::remove_const_t<T>>();
    static_assert(std::is_aggregate_v<std::remove_const_t<T>> && n >= 1 && n <= 16,
                  "add a branch for this number of members");
    if constexpr (n == 1) {
        auto& [a] = x;
        return std::tie(a);
    } else if constexpr (n == 2) {
        auto& [a, b] = x;
        return std::tie(a, b);
    } else if constexpr (n == 3) {
        auto& [a, b, c] = x;
        return std::tie(a, b, c);
    } else if constexpr (n == 4) {
        auto& [a, b, c, d] = x;
        return std::tie(a, b, c, d);
    } else if constexpr (n == 5) {
        auto& [a, b, c, d, e] = x;
        return std::tie(a, b, c, d, e);
    } else if constexpr (n == 6) {
        auto& [a, b, c, d, e, f] = x;
        return std::tie(a, b, c, d, e, f);
    } else if constexpr (n == 7) {
        auto& [a, b, c, d, e, f, g] = x;
        return std::tie(a, b, c, d, e, f, g);
    } else if constexpr (n == 8) {
        auto& [a, b, c, d, e, f, g, h] = x;
        return std::tie(a, b, c, d, e, f, g, h);
    } else if constexpr (n == 9) {
        auto& [a, b, c, d, e, f, g, h, i] = x;
        return std::tie(a, b, c, d, e, f, g, h, i);
    } else if constexpr (n == 10) {
        auto& [a, b, c, d, e, f, g, h, i, j] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j);
    } else if constexpr (n == 11) {
        auto& [a, b, c, d, e, f, g, h, i, j, k] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k);
    } else if constexpr (n == 12) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k, l);
    } else if constexpr (n == 13) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
    } else if constexpr (n == 14) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, o);
    } else if constexpr (n == 15) {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p);
    } else {
        auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q] = x;
        return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q);
    }
}

namespace members_detail {

template <class M>
auto material_members(M& m) {
    static_assert(count<Material>() == 38, "add the new member of Material to the list below");
    return std::tie(m.model, m.diffuse, m.specular, m.emission, m.emits_on_both_sides, m.opacity, m.opacity_cutoff,
                    m.only_shadows, m.vertex_opacity, m.vertex_emission, m.opacity_texture, m.diffuse_texture,
                    m.specular_texture, m.emission_texture, m.ior, m.transmission, m.filter, m.absorption, m.scattering,
                    m.scattering_anisotropy, m.is_thin, m.shininess, m.mirror, m.fresnel, m.metallic, m.roughness,
                    m.specular_weight, m.clearcoat, m.clearcoat_roughness, m.metallic_roughness_texture,
                    m.normal_texture, m.normal_scale, m.transmission_texture, m.specular_weight_texture,
                    m.clearcoat_texture, m.clearcoat_roughness_texture, m.clearcoat_normal_texture,
                    m.clearcoat_normal_scale);
}

}  // namespace members_detail

inline auto members(const Material& m) {
    return members_detail::material_members(m);
}
inline auto members(Material& m) {
    return members_detail::material_members(m);
}
inline auto members(const Triangle& t) {
    return std::tie(t.vertices[0], t.vertices[1], t.vertices[2], t.material);
}
inline auto members(const Assembly& x) {
    return std::tie(x.static_geometry, x.instances, x.cameras);
}
inline auto members(Assembly& x) {
    return std::tie(x.static_geometry, x.instances, x.cameras);
}

}  // namespace realcam::bindings
