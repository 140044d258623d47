#pragma once
#include <cstddef>
#include <cstdint>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

// Declares all effects, apart from the code that simulates them: names, texts and properties in kEffects, and the sets
// for which sampling code is compiled in kCompiledEffects. CONTRIBUTING.md, "Adding an effect", lists the other steps.

/// Effects that are simulated in pixel samples. A template argument of the sampling code, so that an effect that is off
/// costs nothing.
struct Effects {
    bool dispersion = false;
    bool coatings = false;
    bool diffraction = false;

    constexpr bool operator==(const Effects&) const = default;
    /// True if each sample has a wavelength.
    constexpr bool have_wavelengths() const;
    /// True if samples may count in pixels other than their own (SampleSharing). Diffraction alone also has wavelengths
    /// that end in other pixels, but too seldom to be worth the cost.
    constexpr bool share_pixels() const { return dispersion; }
    /// True if all effects of `other` are in this set.
    constexpr bool hold(const Effects& other) const;
};

inline constexpr Effects kNoEffects = {};

/// Sets for which code is compiled, smaller ones first. cmake/RealcamRenderKernels.cmake reads them here and makes
/// kernels for each. A camera with any other set uses the first one that contains it; effects that the camera lacks are
/// skipped at run time.
inline constexpr Effects kCompiledEffects[] = {
    {},
    {.dispersion = true},
    {.coatings = true},
    {.dispersion = true, .coatings = true},
    {.diffraction = true},
    {.dispersion = true, .coatings = true, .diffraction = true},
};

/// All effects of a picture. Those of the exposure, motion_blur and rolling_shutter, are on unless switched off and
/// apply if something moves.
struct EffectChoice : Effects {
    bool ghosts = false;  ///< light reflected by two surfaces of the lens; traced separately from the pixel samples
    double ghost_share = 1e-6;  ///< ghosts with a smaller fraction of the lens's light on the film are left out
    bool film_reflection = false;  ///< ghosts of the film and a surface
    double film_reflectance = 0.05;
    bool motion_blur = true;  ///< false: each row of pixels sees the scene at the middle of its exposure
    bool rolling_shutter = true;  ///< false: the shutter's readout time is taken as 0

    bool is_automatic = false;  ///< the planner decides on effects that the user has not named (cpp/plan)
    std::uint32_t named = 0;  ///< bit mask of the effects that the user has named, in the order of kEffects

    constexpr bool operator==(const EffectChoice&) const = default;
    constexpr bool have_ghosts() const { return ghosts || film_reflection; }
};

/// Aliases, because nvcc puts parentheses around members of these types, about which the host's compiler then warns.
using EffectSwitch = bool EffectChoice::*;
using EffectParameter = double EffectChoice::*;

/// Properties of an effect.
struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python; prefix "-": off; suffix "=" and a number:
                       ///< sets `parameter`
    EffectSwitch member;  ///< its switch in EffectChoice
    EffectParameter parameter = nullptr;  ///< null if the effect has no parameter
    const char* what;  ///< description
    const char* needs;  ///< requirements on lens, scene and camera
    const char* usage = "";  ///< further notes for the user
    bool has_wavelengths = false;  ///< each sample has a wavelength, so an illuminant can be named
    bool needs_full_lens = false;  ///< acts at the lens's surfaces, which only the camera model full has
    bool needs_rotational_lens = false;  ///< needs a centred, rotationally symmetric lens with a flat film
    bool needs_coatings = false;  ///< uses the coatings of the lens file; without them the result is a guess
    bool shows_in_previews = true;  ///< on in previews, which have fewer pixels than requested
    /// Relative render time with the effect on one CPU core and on a GPU: frame benchmark, double Gauss
    /// (benchmarks/effects.py). 0: not measured.
    double cpu_time = 0, gpu_time = 0;

    /// Default if the user does not name the effect.
    constexpr bool is_on() const { return EffectChoice{}.*member; }
    /// True if the effect is a parameter of the sampling code (Effects).
    constexpr bool is_compiled() const {
        EffectChoice alone;
        alone.*member = true;
        return static_cast<const Effects&>(alone) != kNoEffects;
    }
};

inline constexpr EffectInfo kEffects[] = {
    {.name = "dispersion",
     .member = &EffectChoice::dispersion,
     .what = "each sample has a wavelength of its own, for which every glass has its own index",
     .needs = "refractive indices at several wavelengths, and the camera model full",
     .has_wavelengths = true,
     .needs_full_lens = true,
     .cpu_time = 1.12,
     .gpu_time = 1.25},
    {.name = "coatings",
     .member = &EffectChoice::coatings,
     .what = "each surface of the lens loses the light that its glass and coating reflect, or that its mirror absorbs",
     .needs = "coatings in the lens file (glass without a stated coating is assumed to be bare), and the camera model "
              "full",
     .needs_full_lens = true,
     .needs_coatings = true,
     .cpu_time = 1.03,
     .gpu_time = 1.06},
    {.name = "ghosts",
     .member = &EffectChoice::ghosts,
     .parameter = &EffectChoice::ghost_share,
     .what = "light that two surfaces of the lens reflect on its way to the film, from all lights and objects of the "
             "scene",
     .needs = "coatings in the lens file (glass without a stated coating is assumed to be bare), lights, and the "
              "camera model full",
     .usage = "ghosts=1e-8 leaves out ghosts with less than 1e-8 of the lens's light; ghosts alone means 1e-6",
     .needs_full_lens = true,
     .needs_coatings = true,
     .cpu_time = 1.51,
     .gpu_time = 1.25},
    {.name = "film_reflection",
     .member = &EffectChoice::film_reflection,
     .parameter = &EffectChoice::film_reflectance,
     .what = "light that the film or sensor reflects like a mirror, and then a surface of the lens back to it",
     .needs = "the same as ghosts",
     .usage = "with film_reflection=0.1 the film reflects a tenth of the light; film_reflection alone means 0.05",
     .needs_full_lens = true,
     .needs_coatings = true},
    {.name = "diffraction",
     .member = &EffectChoice::diffraction,
     .what = "the edges of the aperture spread light of each wavelength over the film, which gives lights starbursts",
     .needs = "a centred, rotationally symmetric lens",
     .has_wavelengths = true,
     .needs_rotational_lens = true,
     .shows_in_previews = false,
     .cpu_time = 1.12,
     .gpu_time = 1.27},
    {.name = "motion_blur",
     .member = &EffectChoice::motion_blur,
     .what = "objects that move relative to the camera while the shutter is open are blurred",
     .needs = "objects or a camera that move",
     .usage = "on by default; -motion_blur switches it off"},
    {.name = "rolling_shutter",
     .member = &EffectChoice::rolling_shutter,
     .what = "the rows of pixels are exposed one after the other",
     .needs = "a readout time of the camera, and objects or a camera that move",
     .usage = "on by default; -rolling_shutter switches it off"},
};

/// First active effect that has a property; null if there is none.
constexpr const EffectInfo* first_active_with(const EffectChoice& effects, bool EffectInfo::* property) {
    for (const EffectInfo& effect : kEffects)
        if (effects.*effect.member && effect.*property) return &effect;
    return nullptr;
}

/// True if any active effect has a property. A separate loop: with sanitizers, gcc does not accept an address other
/// than null as a constant.
constexpr bool any_active_has(const EffectChoice& effects, bool EffectInfo::* property) {
    for (const EffectInfo& effect : kEffects)
        if (effects.*effect.member && effect.*property) return true;
    return false;
}

constexpr bool Effects::have_wavelengths() const {
    return any_active_has({*this}, &EffectInfo::has_wavelengths);
}

constexpr bool Effects::hold(const Effects& other) const {
    const EffectChoice mine{*this}, others{other};
    for (const EffectInfo& effect : kEffects)
        if (mine.*effect.member < others.*effect.member) return false;
    return true;
}

/// Index in kCompiledEffects of the first set that contains the effects `wanted`. Kernels take an int because nvcc
/// generates no launch code for template arguments of class type.
constexpr int number_of(const Effects& wanted) {
    int number = 0;
    for (const Effects& set : kCompiledEffects) {
        if (set.hold(wanted)) break;
        ++number;
    }
    return number;
}

/// Returns the set without coatings.
constexpr Effects without_coatings(Effects set) {
    set.coatings = false;
    return set;
}

/// True if the code for a set also serves cameras without coatings and has to test for them.
constexpr bool may_lack_coatings(const Effects& set) {
    return set.coatings && number_of(without_coatings(set)) == number_of(set);
}

}  // namespace REALCAM_NAMESPACE
