#pragma once
#include <cstdint>

#include "lanes.hpp"
#include "random.hpp"

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

// Tables of count + 1 cumulative probabilities, from 0 to 1, in steps of 2^-24 (append_cdf). Random numbers have the
// same steps, so an entry is chosen exactly with its probability.

/// Returns the index with cdf[index] <= u < cdf[index + 1].
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

/// Entry drawn from a table.
struct CdfChoice {
    int index;
    float probability;
    float fresh;  ///< random number in (0, 1), from the remainder of u
};

template <int N>
struct CdfChoices {
    Lanes<std::int32_t, N> index;
    Lanes<float, N> probability, fresh;

    REALCAM_INLINE CdfChoice operator[](int lane) const { return {index[lane], probability[lane], fresh[lane]}; }
};

/// Returns the entry whose cumulative probabilities enclose u.
REALCAM_INLINE CdfChoice cdf_choice(int index, float below, float above, float u) {
    const float probability = above - below;
    // u is taken as the middle of its step, because an entry of one step would otherwise always give 0.
    return {index, probability, left_over(u - below + 0x1p-25f, probability)};
}

REALCAM_INLINE CdfChoice choose_from_cdf(const float* cdf, int count, float u) {
    const int index = find_in_cdf(cdf, count, u);
    return cdf_choice(index, cdf[index], cdf[index + 1], u);
}

/// Draws entries for `slots` numbers in lockstep, which is vector code and waits for memory for many at once.
/// `tables`: tables of the same length; that of number i begins at `begin[i]`.
template <int N>
REALCAM_INLINE void choose_from_cdfs(const float* tables, const std::int32_t (&begin)[N], int count,
                                     const float (&u)[N], int slots, CdfChoices<N>& chosen) {
    Lanes<std::int32_t, N> first, last;
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        first[i] = begin[i];
        last[i] = begin[i] + count;
    }
    for (int width = count; width > 1; width = (width + 1) / 2) {
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) {
            const std::int32_t middle = first[i] + (last[i] - first[i]) / 2;
            // If only one entry is left, it is the middle, and stays.
            const bool is_below = tables[middle] <= u[i];
            first[i] = select(is_below, middle, first[i]);
            last[i] = select(is_below, last[i], middle);
        }
    }
    REALCAM_LANES
    for (int i = 0; i < slots; ++i) {
        const std::int32_t at = first[i];
        const CdfChoice choice = cdf_choice(at - begin[i], tables[at], tables[at + 1], u[i]);
        chosen.index[i] = choice.index;
        chosen.probability[i] = choice.probability;
        chosen.fresh[i] = choice.fresh;
    }
}

}  // namespace REALCAM_NAMESPACE
