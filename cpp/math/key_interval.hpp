#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Two successive keys at uniform times from 0 to 1, and a fraction of the interval between them.
struct KeyInterval {
    std::int32_t first;
    float share;
};

/// Returns the interval of a time among `count` keys, which are at least 2.
REALCAM_INLINE KeyInterval key_interval(float time, std::int32_t count) {
    const float position = time * static_cast<float>(count - 1);
    const auto whole = static_cast<std::int32_t>(position);
    const std::int32_t first = whole < 0 ? 0 : whole < count - 1 ? whole : count - 2;
    return {first, position - static_cast<float>(first)};
}

}  // namespace REALCAM_NAMESPACE
