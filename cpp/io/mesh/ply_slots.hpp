#pragma once
#include <array>
#include <cstddef>
#include <string_view>

#include "../../scene/scene_view.hpp"
#include "ply_data.hpp"

namespace realcam::io::ply_detail {

/// Properties of a vertex or a face that are read, as indices in PlyNumbers.
enum PlySlot : std::size_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, slot_count, unread = slot_count };

using PlyNumbers = std::array<double, slot_count + 1>;

inline PlySlot slot_of(std::string_view name) {
    static constexpr std::string_view names[][slot_count] = {
        {"x", "y", "z", "nx", "ny", "nz", "s", "t", "red", "green", "blue", "alpha"},
        {"", "", "", "", "", "", "u", "v", "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
        {"", "", "", "", "", "", "texture_u", "texture_v", "r", "g", "b", "a"}};
    for (const auto& row : names)
        for (std::size_t i = 0; i < slot_count; ++i)
            if (row[i] == name) return static_cast<PlySlot>(i);
    return unread;
}

/// Returns which slots the properties of an element fill.
inline std::array<bool, slot_count + 1> slots_of(const PlyElement& element) {
    std::array<bool, slot_count + 1> has{};
    for (const PlyProperty& p : element.properties) has[p.count_type ? unread : slot_of(p.name)] = true;
    return has;
}

inline bool has_colour(const std::array<bool, slot_count + 1>& has) {
    return has[red] && has[green] && has[blue];
}

/// Converts a stored number to its value: integer colours are fractions of the largest value of their type.
inline double meaning_of(PlySlot slot, PlyType type, double number) {
    if (slot < red || slot > alpha || type.kind == 'f') return number;
    const double values = static_cast<double>(std::size_t{1} << (8 * type.bytes - (type.kind == 'i' ? 1 : 0)));
    return number / (values - 1);
}

inline VertexColor colour_of(const PlyNumbers& n, bool has_alpha) {
    const auto f = [&](PlySlot slot) { return static_cast<float>(n[slot]); };
    return {{f(red), f(green), f(blue)}, has_alpha ? f(alpha) : 1.0f};
}

}  // namespace realcam::io::ply_detail
