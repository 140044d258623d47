#pragma once
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// What is simulated besides what every picture has: an argument of the code that takes samples, so that an effect that
/// is switched off costs nothing.
struct Effects {
    bool dispersion = false;

    constexpr bool operator==(const Effects&) const = default;
    /// Whether it has all that the other one has.
    constexpr bool holds(const Effects& other) const { return dispersion || !other.dispersion; }
};

inline constexpr Effects kNoEffects = {};
inline constexpr Effects kDispersion = {true};

/// The sets for which there is code, the smallest first. A picture is taken with the first that holds all it asks for.
inline constexpr Effects kCompiledEffects[] = {kNoEffects, kDispersion};

constexpr Effects smallest_compiled(const Effects& wanted) {
    for (const Effects& set : kCompiledEffects)
        if (set.holds(wanted)) return set;
    return wanted;
}
/// Its place in kCompiledEffects, for kernels: nvcc writes no code that launches one whose argument is of a class.
constexpr int number_of(const Effects& compiled) {
    int number = 0;
    for (const Effects& set : kCompiledEffects) {
        if (set == compiled) break;
        ++number;
    }
    return number;
}
static_assert(smallest_compiled(kNoEffects) == kNoEffects && smallest_compiled(kDispersion) == kDispersion);

}  // namespace REALCAM_NAMESPACE
