#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// What is simulated besides what every picture has: an argument of the code that takes samples, so that an effect that
/// is switched off costs nothing.
struct Effects {
    bool dispersion = false;
    bool coatings = false;
    bool diffraction = false;

    constexpr bool operator==(const Effects&) const = default;
    /// Whether samples have a wavelength each.
    constexpr bool have_wavelengths() const { return dispersion || diffraction; }
    constexpr bool hold(const Effects& other) const {
        return dispersion >= other.dispersion && coatings >= other.coatings && diffraction >= other.diffraction;
    }
};

inline constexpr Effects kNoEffects = {};

/// The sets for which there is code, the smaller ones first. That of all does without what a camera does not have.
inline constexpr Effects kCompiledEffects[] = {
    kNoEffects,
    {.dispersion = true},
    {.coatings = true},
    {.dispersion = true, .coatings = true},
    {.diffraction = true},
    {.dispersion = true, .coatings = true, .diffraction = true},
};

/// The place in kCompiledEffects of the first that holds these. A number, for kernels: nvcc writes no code that
/// launches one whose argument is of a class.
constexpr int number_of(const Effects& wanted) {
    int number = 0;
    for (const Effects& set : kCompiledEffects) {
        if (set.hold(wanted)) break;
        ++number;
    }
    return number;
}

/// What a picture is to have of all effects. Those of the exposure are there where something moves, unless left out.
struct EffectChoice : Effects {
    bool ghosts = false;  ///< what two surfaces of the lens reflect: found apart from the samples of pixels
    double ghost_share = 1e-6;  ///< ghosts that bring less of the lens's light to the film are left out
    bool film_reflection = false;  ///< ghosts of the film and a surface
    double film_reflectance = 0.05;
    bool motion_blur = true;  ///< else each row of pixels sees the scene in the middle of its exposure
    bool rolling_shutter = true;  ///< else the shutter's readout time is 0

    bool is_automatic = false;  ///< the planner decides on those that nobody has named (cpp/plan)
    std::uint32_t named = 0;  ///< bits: those that somebody has named, in the order of kEffects

    constexpr bool operator==(const EffectChoice&) const = default;
    constexpr bool have_ghosts() const { return ghosts || film_reflection; }
};

}  // namespace REALCAM_NAMESPACE
