#include "effect_names.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "../../number_text.hpp"
#include "../../optics/coating/coated_surface.hpp"
#include "../../optics/trace/lens_dispersion.hpp"

namespace realcam {

namespace {

/// Returns the effect's name in a specification such as "-coatings" or "ghosts=1e-8": without minus sign and parameter.
std::string base_name_of(const std::string& name) {
    const std::size_t begin = name.starts_with('-') ? 1 : 0;
    return name.substr(begin, std::min(name.find('='), name.size()) - begin);
}

/// Parses a number from 0 to 1. Returns std::nullopt for other texts.
std::optional<double> fraction_from(const std::string& text) {
    const double value = number_in(text);
    return value >= 0 && value <= 1 ? std::optional(value) : std::nullopt;
}

}  // namespace

const EffectInfo* find_effect(const std::string& name) {
    const auto* const found = std::ranges::find_if(kEffects, [&](const auto& effect) { return name == effect.name; });
    return found == std::end(kEffects) ? nullptr : found;
}

std::string line_of(const EffectInfo& effect) {
    return std::string(effect.what) + "; needs " + effect.needs + (*effect.usage ? "; " : "") + effect.usage;
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
        text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
    return text;
}

std::string effect_names() {
    std::string names = "auto, none, ";
    for (const EffectInfo& effect : kEffects)
        names += std::string(&effect == kEffects ? "" : ", ") + (effect.is_on() ? "-" : "") + effect.name;
    return names;
}

std::vector<std::string> names_of(const EffectChoice& effects) {
    std::vector<std::string> names;
    if (effects.is_automatic) names.push_back("auto");
    for (const EffectInfo& effect : kEffects) {
        const bool on = effects.*effect.member;
        if (effects.is_automatic ? (effects.named & bit_of(effect)) == 0 : on == effect.is_on()) continue;
        names.push_back((on ? "" : "-") + std::string(effect.name));
        if (effect.parameter && effects.*effect.parameter != EffectChoice().*effect.parameter)
            names.back() += "=" + shortest_text(effects.*effect.parameter);
    }
    return names;
}

EffectChoice effects_named(const std::vector<std::string>& names) {
    EffectChoice effects;
    for (const std::string& name : names) {
        if (name == "none" && names.size() > 1) throw InputError("\"none\" must be the only effect");
        if (name == "none") break;
        if (name == "auto") {
            effects.is_automatic = true;
            continue;
        }
        const bool on = !name.starts_with('-');
        const std::string plain = base_name_of(name);
        const EffectInfo* found = find_effect(plain);
        if (!found)
            throw InputError("unknown effect \"" + name.substr(0, 60) + "\"; expected some of " + effect_names());
        for (const std::string& other : names)
            if (other != name && base_name_of(other) == plain)
                throw InputError(
                    "the effect " + plain + " is " +
                    (on != other.starts_with('-') ? "named with two parameters" : "both named and left out"));
        effects.*found->member = on;
        effects.named |= bit_of(*found);
        const std::size_t equals = name.find('=');
        if (equals == std::string::npos) continue;
        const std::optional<double> value = fraction_from(name.substr(equals + 1));
        if (!found->parameter || !on || !value)
            throw InputError("\"" + name.substr(0, 60) + "\" is not an effect; " +
                             (found->parameter ? "expected a number from 0 to 1 after the equals sign"
                                               : "the effect " + plain + " has no parameter"));
        effects.*found->parameter = *value;
    }
    if (!effects.is_automatic) effects.named = 0;  // so that equal choices are equal
    return effects;
}

namespace {

/// Returns "surface 3 of " or "surfaces 1, 2 and 3 of ", followed by the lens's name. `numbers`: counted from 1.
std::string surfaces_text(const std::vector<int>& numbers, const LensSystem& lens) {
    std::vector<std::string> words;
    for (const int number : numbers) words.push_back(std::to_string(number));
    return (words.size() == 1 ? "surface " : "surfaces ") + listed(words) + " of " + lens.name;
}

}  // namespace

std::vector<std::string> effect_notices(const EffectChoice& effects, const LensSystem& lens) {
    std::vector<std::string> notices;
    if (const std::vector<int> without = non_dispersive_surfaces(lens); effects.dispersion && !without.empty()) {
        const bool one = without.size() == 1;
        notices.push_back(std::string("dispersion: the ") + (one ? "glass of " : "glasses of ") +
                          surfaces_text(without, lens) + (one ? " has" : " have") + " one index only, and so " +
                          (one ? "does" : "do") + " not disperse light");
    }
    std::vector<int> unknown = surfaces_with_unknown_coating(lens);
    for (int& surface : unknown) ++surface;  // counted from 1
    if (any_active_has(effects, &EffectInfo::needs_coatings) && !unknown.empty())
        notices.push_back(std::string(first_active_with(effects, &EffectInfo::needs_coatings)->name) +
                          ": the coating of " + surfaces_text(unknown, lens) +
                          " is unknown; glass is assumed to be uncoated, and a mirror to be perfect");
    return notices;
}

}  // namespace realcam
