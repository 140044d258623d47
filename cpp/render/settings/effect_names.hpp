#pragma once
#include <functional>
#include <string>
#include <vector>

#include "../../camera/effects/effects.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the bit of an effect in EffectChoice::named. `effect`: an element of kEffects.
inline std::uint32_t bit_of(const EffectInfo& effect) {
    return 1u << (&effect - kEffects);
}

/// Returns the effect of this name in kEffects, or null if the name is unknown.
const EffectInfo* find_effect(const std::string& name);

/// Returns a one-line description of an effect and of its requirements, for help texts.
std::string line_of(const EffectInfo& effect);

/// Joins words with commas and "and": "1, 2 and 3".
std::string listed(const std::vector<std::string>& words);

/// Returns the names of the effects with a property, such as "dispersion and diffraction". `property`: pointer to a
/// bool member of EffectInfo.
template <class Property>
std::string effects_that(Property property) {
    std::vector<std::string> names;
    for (const EffectInfo& effect : kEffects)
        if (std::invoke(property, effect)) names.push_back(effect.name);
    return listed(names);
}

/// Returns all words that effects_named accepts, separated by commas, for messages. Effects that are on by default are
/// listed with the minus sign that switches them off.
std::string effect_names();

/// Returns the specifications by which a choice differs from the default, in the form that effects_named parses: "name"
/// or "name=parameter" for effects that are switched on, "-name" for those that are switched off.
std::vector<std::string> names_of(const EffectChoice& effects);

/// Parses specifications of effects (names_of, effect_names). Throws InputError if a name is unknown, if an effect is
/// specified twice in different ways, if a parameter is invalid, or if "none" is not the only one.
EffectChoice effects_named(const std::vector<std::string>& names);

/// Returns a sentence for each kind of data that the effects need and the lens lacks: dispersion of glasses, coatings.
/// The picture is taken with default values instead.
std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
