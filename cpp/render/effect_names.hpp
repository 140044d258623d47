#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python; with a "-" before it: left out
    const char* line;  ///< what it is, and what it needs of lens, scene and camera
    bool EffectChoice::* member;

    /// Where nobody names it.
    constexpr bool is_on() const { return EffectChoice{}.*member; }
};

inline constexpr std::array<EffectInfo, 3> kEffects = {{
    {"dispersion",
     "each sample has a wavelength of its own, for which every glass has its own index; needs glasses with more than "
     "one index, nothing of the scene, and the camera model full",
     &EffectChoice::dispersion},
    {"motion_blur",
     "what moves while the shutter is open is blurred; needs objects or a camera that move; on unless left out, "
     "as -motion_blur",
     &EffectChoice::motion_blur},
    {"rolling_shutter",
     "the rows of pixels are exposed one after the other; needs a readout time of the camera, and objects or a "
     "camera that move; on unless left out, as -rolling_shutter",
     &EffectChoice::rolling_shutter},
}};

inline std::string effect_names() {
    std::string names;
    for (const EffectInfo& effect : kEffects)
        names += std::string(names.empty() ? "" : ", ") + (effect.is_on() ? "-" : "") + effect.name;
    return names;
}

/// Those that are switched on or left out, as effects_named understands them.
inline std::vector<std::string> names_of(const EffectChoice& effects) {
    std::vector<std::string> names;
    for (const EffectInfo& effect : kEffects) {
        const bool on = effects.*effect.member;
        if (on != effect.is_on()) names.push_back((on ? "" : "-") + std::string(effect.name));
    }
    return names;
}

/// Throws InputError for a name that is none, and where one is both named and left out.
inline EffectChoice effects_named(const std::vector<std::string>& names) {
    EffectChoice effects;
    for (const std::string& name : names) {
        const bool on = !name.starts_with('-');
        const std::string plain = name.substr(on ? 0 : 1);
        const auto found = std::find_if(kEffects.begin(), kEffects.end(),
                                        [&](const EffectInfo& effect) { return plain == effect.name; });
        if (found == kEffects.end())
            throw InputError("unknown effect \"" + name.substr(0, 60) + "\"; some of " + effect_names() +
                             " are wanted");
        if (std::find(names.begin(), names.end(), (on ? "-" : "") + plain) != names.end())
            throw InputError("the effect " + plain + " is both named and left out");
        effects.*found->member = on;
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
