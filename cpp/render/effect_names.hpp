#pragma once
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

struct EffectInfo {
    const char* name;  ///< on the command line, in shot files and in Python; with a "-" before it: left out; with "="
                       ///< and a number behind it: with that parameter
    const char* line;  ///< what it is, and what it needs of lens, scene and camera
    bool EffectChoice::* member;
    double EffectChoice::* parameter = nullptr;  ///< null: it has none

    /// Where nobody names it.
    constexpr bool is_on() const { return EffectChoice{}.*member; }
};

inline constexpr std::array<EffectInfo, 7> kEffects = {{
    {"dispersion",
     "each sample has a wavelength of its own, for which every glass has its own index; needs glasses with more than "
     "one index, nothing of the scene, and the camera model full",
     &EffectChoice::dispersion},
    {"coatings",
     "each surface of the lens takes from the light what its glass and coating reflect, or its mirror keeps; needs "
     "coatings in the lens file (glass of which it says nothing is taken as bare), nothing of the scene, and the "
     "camera "
     "model full",
     &EffectChoice::coatings},
    {"ghosts",
     "light that two surfaces of the lens reflect on its way to the film, from all lights and objects of the scene; "
     "needs coatings in the lens file (glass of which it says nothing is taken as bare), lights, and the camera model "
     "full; ghosts=1e-8 leaves out those with less than 1e-8 of the lens's light, where ghosts alone means 1e-6",
     &EffectChoice::ghosts, &EffectChoice::ghost_share},
    {"film_reflection",
     "light that the film or sensor reflects like a mirror, and then a surface of the lens back to it; needs what "
     "ghosts needs; film_reflection=0.1 reflects a tenth, where film_reflection alone means 0.05",
     &EffectChoice::film_reflection, &EffectChoice::film_reflectance},
    {"diffraction",
     "the edges of the aperture spread light of each wavelength over the film, and make stars of lamps; needs nothing "
     "of "
     "lens, scene and camera",
     &EffectChoice::diffraction},
    {"motion_blur",
     "what moves while the shutter is open is blurred; needs objects or a camera that move; on unless left out, "
     "as -motion_blur",
     &EffectChoice::motion_blur},
    {"rolling_shutter",
     "the rows of pixels are exposed one after the other; needs a readout time of the camera, and objects or a "
     "camera that move; on unless left out, as -rolling_shutter",
     &EffectChoice::rolling_shutter},
}};

namespace effect_names_detail {

/// Without what stands before and behind it.
inline std::string effect_of(const std::string& name) {
    const std::size_t begin = name.starts_with('-') ? 1 : 0;
    return name.substr(begin, std::min(name.find('='), name.size()) - begin);
}

inline std::optional<double> share_from(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 1)) return std::nullopt;
    return value;
}

inline std::string shortest(double value) {
    char text[32];
    const auto result = std::to_chars(text, text + sizeof text, value);
    return {text, result.ptr};
}

}  // namespace effect_names_detail

/// Of EffectChoice::named.
inline std::uint32_t bit_of(const EffectInfo& effect) {
    return 1u << (&effect - kEffects.data());
}

/// By the name in kEffects; null for one that is none.
inline const EffectInfo* find_effect(const std::string& name) {
    const auto found =
        std::find_if(kEffects.begin(), kEffects.end(), [&](const EffectInfo& effect) { return name == effect.name; });
    return found == kEffects.end() ? nullptr : &*found;
}

inline std::string effect_names() {
    std::string names = "auto, none, ";
    for (const EffectInfo& effect : kEffects)
        names += std::string(&effect == kEffects.data() ? "" : ", ") + (effect.is_on() ? "-" : "") + effect.name;
    return names;
}

/// Those that are switched on or left out, as effects_named understands them.
inline std::vector<std::string> names_of(const EffectChoice& effects) {
    std::vector<std::string> names;
    if (effects.is_automatic) names.push_back("auto");
    for (const EffectInfo& effect : kEffects) {
        const bool on = effects.*effect.member;
        if (effects.is_automatic ? (effects.named & bit_of(effect)) == 0 : on == effect.is_on()) continue;
        names.push_back((on ? "" : "-") + std::string(effect.name));
        if (effect.parameter && effects.*effect.parameter != EffectChoice().*effect.parameter)
            names.back() += "=" + effect_names_detail::shortest(effects.*effect.parameter);
    }
    return names;
}

/// "none" stands alone. Throws InputError for a name that is none, and where one is both named and left out.
inline EffectChoice effects_named(const std::vector<std::string>& names) {
    EffectChoice effects;
    for (const std::string& name : names) {
        if (name == "none" && names.size() > 1)
            throw InputError("\"none\" stands alone; other effects are named beside it");
        if (name == "none") break;
        if (name == "auto") {
            effects.is_automatic = true;
            continue;
        }
        const bool on = !name.starts_with('-');
        const std::string plain = effect_names_detail::effect_of(name);
        const EffectInfo* found = find_effect(plain);
        if (!found)
            throw InputError("unknown effect \"" + name.substr(0, 60) + "\"; some of " + effect_names() +
                             " are wanted");
        for (const std::string& other : names)
            if (other != name && effect_names_detail::effect_of(other) == plain)
                throw InputError(
                    "the effect " + plain + " is " +
                    (on != other.starts_with('-') ? "named with two parameters" : "both named and left out"));
        effects.*found->member = on;
        effects.named |= bit_of(*found);
        const std::size_t equals = name.find('=');
        if (equals == std::string::npos) continue;
        const std::optional<double> value = effect_names_detail::share_from(name.substr(equals + 1));
        if (!found->parameter || !on || !value)
            throw InputError("\"" + name.substr(0, 60) + "\" is no effect; " +
                             (found->parameter ? "after the equals sign a share from 0 to 1 is wanted"
                                               : "the effect " + plain + " has no parameter"));
        effects.*found->parameter = *value;
    }
    if (!effects.is_automatic) effects.named = 0;  // so that equal choices are equal
    return effects;
}

namespace effect_names_detail {

/// "surface 3 of ", "surfaces 1, 2 and 3 of " and the lens. `numbers`: from 1.
inline std::string surfaces_text(const std::vector<int>& numbers, const LensSystem& lens) {
    std::string text = numbers.size() == 1 ? "surface " : "surfaces ";
    for (std::size_t i = 0; i < numbers.size(); ++i)
        text += (i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ") + std::to_string(numbers[i]);
    return text + " of " + lens.name;
}

}  // namespace effect_names_detail

/// What lens, scene and camera cannot give of the effects, a sentence each. The picture is taken without it.
inline std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens) {
    using effect_names_detail::surfaces_text;
    std::vector<std::string> notices;
    if (const std::vector<int> without = surfaces_with_one_index(lens); effects.dispersion && !without.empty()) {
        const bool one = without.size() == 1;
        notices.push_back(std::string("dispersion: the ") + (one ? "glass of " : "glasses of ") +
                          surfaces_text(without, lens) + (one ? " has" : " have") + " one index only, and so " +
                          (one ? "does" : "do") + " not disperse light");
    }
    std::vector<int> unknown = surfaces_with_unknown_coating(lens);
    for (int& surface : unknown) ++surface;
    if ((effects.coatings || effects.have_ghosts()) && !unknown.empty())
        notices.push_back(std::string(effects.coatings ? "coatings"
                                      : effects.ghosts ? "ghosts"
                                                       : "film_reflection") +
                          ": it is not known what covers " + surfaces_text(unknown, lens) +
                          "; glass is taken as bare, and a mirror as perfect");
    return notices;
}

}  // namespace REALCAM_NAMESPACE
