#pragma once
#include <cstdint>

#include "lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Cell of an alias table, from which entries are drawn by their weights with one look-up, however many there are
/// (Walker 1977). Made by append_alias_table.
struct AliasEntry {
    float kept;          ///< probability with which this cell yields its own entry
    std::int32_t other;  ///< the entry that it yields otherwise
};

/// Returns the entry, from 0 to count - 1, that u in [0, 1) draws. `first`: index of the table's first cell in an array
/// of tables.
REALCAM_INLINE std::int32_t draw_entry(const AliasEntry* tables, std::int32_t first, std::int32_t count, float u) {
    const float scaled = u * static_cast<float>(count);
    const auto rounded_down = static_cast<std::int32_t>(scaled);
    const std::int32_t bucket = select(rounded_down < count, rounded_down, count - 1);
    const AliasEntry& at = tables[first + bucket];
    return select(scaled - static_cast<float>(bucket) < at.kept, bucket, at.other);
}

}  // namespace REALCAM_NAMESPACE
