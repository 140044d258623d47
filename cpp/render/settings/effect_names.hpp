#pragma once
#include <functional>
#include <string>
#include <vector>

#include "../../camera/effects/effects.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The bit of an effect in EffectChoice::named.
inline std::uint32_t bit_of(const EffectInfo& effect) {
    return 1u << (&effect - kEffects);
}

/// Finds an effect by its name in kEffects; null if the name is unknown.
const EffectInfo* find_effect(const std::string& name);

/// One-line description of an effect and of its requirements.
std::string line_of(const EffectInfo& effect);

/// Joins words: "1, 2 and 3".
std::string listed(const std::vector<std::string>& words);

/// Names of the effects with a property, a member of EffectInfo: "dispersion and diffraction".
template <class Property>
std::string effects_that(Property property) {
    std::vector<std::string> names;
    for (const EffectInfo& effect : kEffects)
        if (std::invoke(property, effect)) names.push_back(effect.name);
    return listed(names);
}

std::string effect_names();

/// Names of the effects that are switched on or left out, in the form that effects_named parses.
std::vector<std::string> names_of(const EffectChoice& effects);

/// Parses names of effects; "none" must be the only one. Throws InputError if a name is unknown, or an effect is both
/// named and left out.
EffectChoice effects_named(const std::vector<std::string>& names);

/// Data for the effects that the lens lacks, a sentence each. The picture is taken without them.
std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
