#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Position in an animation whose keys are at uniform times from 0 to 1.
struct KeyInterval {
    std::int32_t first;  ///< index of the key at or before the time; the next key is `first` + 1
    float share;         ///< fraction, from 0 to 1, of the interval between the two keys
};

/// Returns the position of a time from 0 to 1 among `count` keys. There must be at least two keys.
REALCAM_INLINE KeyInterval key_interval(float time, std::int32_t count) {
    const float position = time * static_cast<float>(count - 1);
    const auto whole = static_cast<std::int32_t>(position);
    const std::int32_t first = whole < 0 ? 0 : whole < count - 1 ? whole : count - 2;
    return {first, position - static_cast<float>(first)};
}

}  // namespace REALCAM_NAMESPACE
