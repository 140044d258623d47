#pragma once
#include <functional>
#include <string>
#include <vector>

#include "../camera/effects.hpp"
#include "../optics/prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The bit of an effect in EffectChoice::named.
inline std::uint32_t bit_of(const EffectInfo& effect) {
    return 1u << (&effect - kEffects);
}

/// By the name in kEffects; null for one that is none.
const EffectInfo* find_effect(const std::string& name);

/// What an effect is and what it needs, in a line.
std::string line_of(const EffectInfo& effect);

/// "1, 2 and 3".
std::string listed(const std::vector<std::string>& words);

/// The names of those with a property, a member of EffectInfo: "dispersion and diffraction".
template <class Property>
std::string effects_that(Property property) {
    std::vector<std::string> names;
    for (const EffectInfo& effect : kEffects)
        if (std::invoke(property, effect)) names.push_back(effect.name);
    return listed(names);
}

std::string effect_names();

/// Those that are switched on or left out, as effects_named understands them.
std::vector<std::string> names_of(const EffectChoice& effects);

/// "none" stands alone. Throws InputError for a name that is none, and where one is both named and left out.
EffectChoice effects_named(const std::vector<std::string>& names);

/// What lens, scene and camera cannot give of the effects, a sentence each. The picture is taken without it.
std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
