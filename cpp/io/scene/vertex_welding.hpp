#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

/// Returns, for each of `count` items, the index of the first item that equals it. `hash(i)`: hash of item i; `equal(i,
/// j)`: true if two items are equal. Uses an open-addressing table of indices: a map of keys would store every vertex a
/// second time.
template <class Hash, class Equal>
std::vector<std::uint32_t> first_equal(std::size_t count, Hash hash, Equal equal, Checkpoint& checkpoint) {
    constexpr std::uint32_t kEmpty = 0xffffffffu;
    const std::size_t mask = std::bit_ceil(2 * count + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, kEmpty), first(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t slot = static_cast<std::size_t>(hash(i)) & mask;
        checkpoint.pass();
        while (table[slot] != kEmpty && !equal(table[slot], i)) slot = (slot + 1) & mask;
        if (table[slot] == kEmpty) table[slot] = static_cast<std::uint32_t>(i);
        first[i] = table[slot];
    }
    return first;
}

/// Returns a hash for first_equal; 0 and -0 have the same one.
std::uint64_t hash_of(Vec3d position);

/// Merges vertices that are equal in position, normal, texture coordinates and colour, and drops those that no triangle
/// uses. Triangles keep their order, and vertices the order of their first appearance.
void weld_vertices(Scene& scene, Checkpoint& checkpoint);

}  // namespace realcam::io
