#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Two successive keys at even times from 0 to 1, and a share of the way from the first to the second.
struct KeyInterval {
    std::int32_t first;
    float share;
};

/// `count` is 2 or more.
REALCAM_INLINE KeyInterval key_interval(float time, std::int32_t count) {
    const float place = time * static_cast<float>(count - 1);
    const auto whole = static_cast<std::int32_t>(place);
    const std::int32_t first = whole < 0 ? 0 : whole < count - 1 ? whole : count - 2;
    return {first, place - static_cast<float>(first)};
}

}  // namespace REALCAM_NAMESPACE
