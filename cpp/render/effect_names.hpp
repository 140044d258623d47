#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python
    const char* line;  ///< what it is, and what it needs of lens, scene and camera
    bool Effects::* member;
};

inline constexpr std::array<EffectInfo, 1> kEffects = {{
    {"dispersion",
     "each sample has a wavelength of its own, for which every glass has its own index; needs glasses with more than "
     "one index, nothing of the scene, and the camera model full",
     &Effects::dispersion},
}};

inline std::string effect_names() {
    std::string names;
    for (const EffectInfo& effect : kEffects) names += std::string(names.empty() ? "" : ", ") + effect.name;
    return names;
}

inline std::vector<std::string> names_of(const Effects& effects) {
    std::vector<std::string> names;
    for (const EffectInfo& effect : kEffects)
        if (effects.*effect.member) names.emplace_back(effect.name);
    return names;
}

/// Throws InputError for a name that is none.
inline Effects effects_named(const std::vector<std::string>& names) {
    Effects effects;
    for (const std::string& name : names) {
        const auto found = std::find_if(kEffects.begin(), kEffects.end(),
                                        [&](const EffectInfo& effect) { return name == effect.name; });
        if (found == kEffects.end())
            throw InputError("unknown effect \"" + name.substr(0, 60) + "\"; some of " + effect_names() +
                             " are wanted");
        effects.*found->member = true;
    }
    return effects;
}

/// What lens, scene and camera cannot give of the effects, a sentence each. The picture is taken without it.
inline std::vector<std::string> effect_notices(const Effects& effects, const LensSystem& lens) {
    const std::vector<int> without = surfaces_with_one_index(lens);
    if (!effects.dispersion || without.empty()) return {};
    std::string numbers;
    for (std::size_t i = 0; i < without.size(); ++i)
        numbers += (i == 0 ? "" : i + 1 == without.size() ? " and " : ", ") + std::to_string(without[i]);
    const bool one = without.size() == 1;
    return {std::string("dispersion: the ") + (one ? "glass of surface " : "glasses of surfaces ") + numbers + " of " +
            lens.name + (one ? " has" : " have") + " one index only, and so " + (one ? "does" : "do") +
            " not disperse light"};
}

}  // namespace REALCAM_NAMESPACE
