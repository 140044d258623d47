#pragma once
#include <cstddef>
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

// All that the program has to know of each effect, but for the code that simulates it, stands in this file: names,
// words and properties in kEffects, and the sets for which code that takes samples is compiled in kCompiledEffects.
// CONTRIBUTING.md, "Adding an effect", says what else there is to do.

/// What is simulated besides what every picture has: an argument of the code that takes samples, so that an effect that
/// is switched off costs nothing.
struct Effects {
    bool dispersion = false;
    bool coatings = false;
    bool diffraction = false;

    constexpr bool operator==(const Effects&) const = default;
    /// Whether samples have a wavelength each.
    constexpr bool have_wavelengths() const;
    /// Whether samples may count in other pixels than their own (SampleSharing). Diffraction alone also has wavelengths
    /// that end in others, but so seldom that it pays less than it takes.
    constexpr bool share_pixels() const { return dispersion; }
    constexpr bool hold(const Effects& other) const;
};

inline constexpr Effects kNoEffects = {};

/// The sets for which there is code, the smaller ones first. cmake/RealcamRenderKernels.cmake reads them here, and
/// makes kernels for each. A camera with other effects gets the first set that holds them; what it lacks of that is
/// left out.
inline constexpr Effects kCompiledEffects[] = {
    {},
    {.dispersion = true},
    {.coatings = true},
    {.dispersion = true, .coatings = true},
    {.diffraction = true},
    {.dispersion = true, .coatings = true, .diffraction = true},
};

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

/// Named, because nvcc puts parentheses around members of such types, of which the host's compiler then warns.
using EffectSwitch = bool EffectChoice::*;
using EffectParameter = double EffectChoice::*;

/// Of one effect.
struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python; with a "-" before it: left out; with "="
                       ///< and a number behind it: with that parameter
    EffectSwitch member;
    EffectParameter parameter = nullptr;  ///< null: it has none
    const char* what;  ///< it is
    const char* needs;  ///< of lens, scene and camera
    const char* usage = "";  ///< what else a user should know
    bool has_wavelengths = false;  ///< each sample has one, so that an illuminant can be named
    bool needs_full_lens = false;  ///< it happens at the lens's surfaces, which only the camera model full has
    bool needs_round_lens = false;  ///< a centred one of revolution before a flat film
    bool needs_coatings = false;  ///< of the lens file; without them it is a guess
    bool shows_in_previews = true;  ///< in pictures of fewer pixels than were asked for
    /// Of a picture of the frame benchmark with it over one without, on a core and on a GPU (benchmarks/effects.py, the
    /// double Gauss). 0: not measured.
    double cpu_time = 0, gpu_time = 0;

    /// Where nobody names it.
    constexpr bool is_on() const { return EffectChoice{}.*member; }
    /// Whether code that takes samples is compiled with and without it.
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
     .needs = "glasses with more than one index, nothing of the scene, and the camera model full",
     .has_wavelengths = true,
     .needs_full_lens = true,
     .cpu_time = 1.12,
     .gpu_time = 1.24},
    {.name = "coatings",
     .member = &EffectChoice::coatings,
     .what = "each surface of the lens takes from the light what its glass and coating reflect, or its mirror keeps",
     .needs = "coatings in the lens file (glass of which it says nothing is taken as bare), nothing of the scene, and "
              "the camera model full",
     .needs_full_lens = true,
     .needs_coatings = true,
     .cpu_time = 1.03,
     .gpu_time = 1.05},
    {.name = "ghosts",
     .member = &EffectChoice::ghosts,
     .parameter = &EffectChoice::ghost_share,
     .what = "light that two surfaces of the lens reflect on its way to the film, from all lights and objects of the "
             "scene",
     .needs = "coatings in the lens file (glass of which it says nothing is taken as bare), lights, and the camera "
              "model full",
     .usage = "ghosts=1e-8 leaves out those with less than 1e-8 of the lens's light, where ghosts alone means 1e-6",
     .needs_full_lens = true,
     .needs_coatings = true,
     .cpu_time = 1.51,
     .gpu_time = 1.25},
    {.name = "film_reflection",
     .member = &EffectChoice::film_reflection,
     .parameter = &EffectChoice::film_reflectance,
     .what = "light that the film or sensor reflects like a mirror, and then a surface of the lens back to it",
     .needs = "what ghosts needs",
     .usage = "film_reflection=0.1 reflects a tenth, where film_reflection alone means 0.05",
     .needs_full_lens = true,
     .needs_coatings = true},
    {.name = "diffraction",
     .member = &EffectChoice::diffraction,
     .what = "the edges of the aperture spread light of each wavelength over the film, and make stars of lamps",
     .needs = "nothing of lens, scene and camera",
     .has_wavelengths = true,
     .needs_round_lens = true,
     .shows_in_previews = false,
     .cpu_time = 1.12,
     .gpu_time = 1.25},
    {.name = "motion_blur",
     .member = &EffectChoice::motion_blur,
     .what = "what moves while the shutter is open is blurred",
     .needs = "objects or a camera that move",
     .usage = "on unless left out, as -motion_blur"},
    {.name = "rolling_shutter",
     .member = &EffectChoice::rolling_shutter,
     .what = "the rows of pixels are exposed one after the other",
     .needs = "a readout time of the camera, and objects or a camera that move",
     .usage = "on unless left out, as -rolling_shutter"},
};

/// The first that is on and has a property; null: none.
constexpr const EffectInfo* first_that(const EffectChoice& effects, bool EffectInfo::* property) {
    for (const EffectInfo& effect : kEffects)
        if (effects.*effect.member && effect.*property) return &effect;
    return nullptr;
}

/// A loop of its own: with sanitizers, gcc does not take an address other than null for a constant.
constexpr bool any_is(const EffectChoice& effects, bool EffectInfo::* property) {
    for (const EffectInfo& effect : kEffects)
        if (effects.*effect.member && effect.*property) return true;
    return false;
}

constexpr bool Effects::have_wavelengths() const {
    return any_is({*this}, &EffectInfo::has_wavelengths);
}

constexpr bool Effects::hold(const Effects& other) const {
    const EffectChoice mine{*this}, others{other};
    for (const EffectInfo& effect : kEffects)
        if (mine.*effect.member < others.*effect.member) return false;
    return true;
}

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

constexpr Effects without_coatings(Effects set) {
    set.coatings = false;
    return set;
}

/// Whether the code for a set also serves cameras without coatings, so that it has to look.
constexpr bool may_lack_coatings(const Effects& set) {
    return set.coatings && number_of(without_coatings(set)) == number_of(set);
}

}  // namespace REALCAM_NAMESPACE
