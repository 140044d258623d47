#pragma once
#include <cstdint>

#include "lanes.hpp"
#include "random.hpp"

namespace REALCAM_NAMESPACE {

/// Cell of an alias table, from which an index is drawn with a probability proportional to its weight by one look-up,
/// whatever the size of the table (Walker 1977). Made by append_alias_table (sampling_tables.hpp).
struct AliasEntry {
    float own_probability;  ///< probability with which this cell yields its own index
    std::int32_t alias;  ///< the index that it yields otherwise
};

/// Draws an index from 0 to count - 1 from an alias table by a random number u in [0, 1). `first`: position of the
/// table's first cell in an array of tables; `count`: number of its cells.
REALCAM_INLINE std::int32_t draw_entry(const AliasEntry* tables, std::int32_t first, std::int32_t count, float u) {
    const float scaled = u * static_cast<float>(count);
    const auto rounded_down = static_cast<std::int32_t>(scaled);
    const std::int32_t bucket = select(rounded_down < count, rounded_down, count - 1);
    const AliasEntry& cell = tables[first + bucket];
    return select(scaled - static_cast<float>(bucket) < cell.own_probability, bucket, cell.alias);
}

// The functions below read tables of count + 1 cumulative probabilities, from 0 to 1, rounded to multiples of 2^-24
// (append_cdf). Random floats are multiples of 2^-24, too (unit_float), so that an entry is drawn exactly with the
// probability that the table states.

/// Returns the index with cdf[index] <= u < cdf[index + 1], for u in [0, 1).
REALCAM_INLINE int find_in_cdf(const float* cdf, int count, float u) {
    int first = 0, last = count;
    while (first + 1 < last) {
        const int middle = (first + last) / 2;
        if (cdf[middle] <= u) {
            first = middle;
        } else {
            last = middle;
        }
    }
    return first;
}

/// Index drawn from a table, with its probability.
struct CdfChoice {
    int index;
    float probability;
    float fresh;  ///< random number in (0, 1), independent of the index: position of u within the entry's interval
};

/// N drawn indices in structure-of-arrays form.
template <int N>
struct CdfChoices {
    Lanes<std::int32_t, N> index;
    Lanes<float, N> probability, fresh;

    REALCAM_INLINE CdfChoice operator[](int lane) const { return {index[lane], probability[lane], fresh[lane]}; }
};

/// Returns the choice of this index, whose cumulative probabilities `below` and `above` enclose u.
REALCAM_INLINE CdfChoice cdf_choice(int index, float below, float above, float u) {
    const float probability = above - below;
    // Half a step of 2^-24 is added to u, because `fresh` would otherwise always be 0 for an entry of one step.
    return {index, probability, remapped_random(u - below + 0x1p-25f, probability)};
}

/// Draws an index from a table by a random number u in [0, 1).
REALCAM_INLINE CdfChoice choose_from_cdf(const float* cdf, int count, float u) {
    const int index = find_in_cdf(cdf, count, u);
    return cdf_choice(index, cdf[index], cdf[index + 1], u);
}

/// Draws an index in each of the first `used_lanes` lanes. The binary searches run in lockstep: they become vector
/// code, and their memory accesses overlap. `tables`: an array of tables of `count` entries each; lane i searches the
/// one that begins at `begin[i]`, by the random number `u[i]`.
template <int N>
REALCAM_INLINE void choose_from_cdfs(const float* tables, const std::int32_t (&begin)[N], int count,
                                     const float (&u)[N], int used_lanes, CdfChoices<N>& chosen) {
    Lanes<std::int32_t, N> first, last;
    REALCAM_LANES
    for (int i = 0; i < used_lanes; ++i) {
        first[i] = begin[i];
        last[i] = begin[i] + count;
    }
    for (int width = count; width > 1; width = (width + 1) / 2) {
        REALCAM_LANES
        for (int i = 0; i < used_lanes; ++i) {
            const std::int32_t middle = first[i] + (last[i] - first[i]) / 2;
            // If only one entry is left, `middle` equals `first`, and the interval stays.
            const bool is_below = tables[middle] <= u[i];
            first[i] = select(is_below, middle, first[i]);
            last[i] = select(is_below, last[i], middle);
        }
    }
    REALCAM_LANES
    for (int i = 0; i < used_lanes; ++i) {
        const std::int32_t at = first[i];
        const CdfChoice choice = cdf_choice(at - begin[i], tables[at], tables[at + 1], u[i]);
        chosen.index[i] = choice.index;
        chosen.probability[i] = choice.probability;
        chosen.fresh[i] = choice.fresh;
    }
}

}  // namespace REALCAM_NAMESPACE
