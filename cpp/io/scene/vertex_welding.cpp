#include "vertex_welding.hpp"

#include <utility>

namespace realcam::io {
namespace {

/// Returns the state of a hash after another value.
std::uint64_t mix(std::uint64_t state, std::uint64_t value) {
    state = (state ^ value) * 0x9e3779b97f4a7c15ull;
    return state ^ (state >> 29);
}

/// Replaces a list by its elements at these indices; an empty list stays empty.
template <class T>
void select_elements(std::vector<T>& values, const std::vector<std::uint32_t>& indices) {
    if (values.empty()) return;
    std::vector<T> selected;
    selected.reserve(indices.size());
    for (const std::uint32_t i : indices) selected.push_back(values[i]);
    values = std::move(selected);
}

}  // namespace

std::uint64_t hash_of(Vec3d p) {
    std::uint64_t state = 0;
    // + 0.0, because equal numbers must have equal bits, which 0 and -0 have not.
    for (const double value : {p.x, p.y, p.z}) state = mix(state, std::bit_cast<std::uint64_t>(value + 0.0));
    return mix(state, state >> 32);
}

void weld_vertices(Scene& scene, Checkpoint& checkpoint) {
    const auto hash = [&](std::size_t i) {
        std::uint64_t state = hash_of(scene.positions_m[i]);
        const auto add = [&](float value) { state = mix(state, std::bit_cast<std::uint32_t>(value + 0.0f)); };
        if (!scene.normals.empty()) add(scene.normals[i].x), add(scene.normals[i].y), add(scene.normals[i].z);
        for (const std::vector<Vec2f>* uvs : {&scene.uvs, &scene.second_uvs})
            if (!uvs->empty()) add((*uvs)[i].x), add((*uvs)[i].y);
        if (!scene.colors.empty())
            add(scene.colors[i].color.r), add(scene.colors[i].color.g), add(scene.colors[i].alpha);
        return mix(state, state >> 32);
    };
    const auto equal = [&](std::size_t a, std::size_t b) {
        return scene.positions_m[a] == scene.positions_m[b] &&
               (scene.normals.empty() || scene.normals[a] == scene.normals[b]) &&
               (scene.uvs.empty() || scene.uvs[a] == scene.uvs[b]) &&
               (scene.second_uvs.empty() || scene.second_uvs[a] == scene.second_uvs[b]) &&
               (scene.colors.empty() || scene.colors[a] == scene.colors[b]);
    };
    const std::vector<std::uint32_t> first = first_equal(scene.positions_m.size(), hash, equal, checkpoint);

    std::vector<bool> used(first.size(), false);
    for (const Triangle& t : scene.triangles) {
        checkpoint.pass();
        for (const std::uint32_t v : t.vertices) used[first[v]] = true;
    }
    std::vector<std::uint32_t> kept, new_index(first.size(), 0);
    for (std::uint32_t v = 0; v < first.size(); ++v) {
        if (!used[v]) continue;
        new_index[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(v);
    }
    if (kept.size() == first.size()) return;
    for (Triangle& t : scene.triangles) {
        checkpoint.pass();
        for (std::uint32_t& v : t.vertices) v = new_index[first[v]];
    }
    select_elements(scene.positions_m, kept);
    select_elements(scene.normals, kept);
    select_elements(scene.uvs, kept);
    select_elements(scene.second_uvs, kept);
    select_elements(scene.colors, kept);
}

}  // namespace realcam::io
