#include "lens_glass.hpp"

#include <algorithm>
#include <cmath>

#include "lens_material.hpp"
#include "lens_text.hpp"
#include "nearest_names.hpp"
#include "printable.hpp"
#include "text_number.hpp"

namespace realcam::io {
namespace {

/// The catalogue that a file means: "SCHOTT", "SUMITA_AUG2011", "NIKON-HIKARI", "MISC"; empty for one that is not
/// known.
std::string maker_of(const std::string& catalogue) {
    const std::string word = upper_case(catalogue);
    for (const char* maker : {"schott", "ohara", "hoya", "cdgm", "hikari", "sumita"})
        if (word.find(upper_case(maker)) != std::string::npos) return maker;
    // Zemax's and CODE V's catalogues of what no glass maker lists.
    if (word == "MISC" || word == "SPECIAL") return "misc";
    return {};
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + in_quotes(name);
    return text;
}

/// Whether two glasses bend light alike, to the digits of the makers' tables.
bool same_indices(const Glass& a, const Glass& b) {
    for (double nm = 400; nm <= 700; nm += 25)
        if (std::fabs(a.index(nm) - b.index(nm)) > 1e-6) return false;
    return true;
}

Glass catalogued(const CatalogueName& found) {
    const bool is_unique = catalogue_names_like(found.name).size() == 1;
    return catalogue_glass(is_unique ? found.name : found.full());
}

std::string how_to_settle(const std::string& name) {
    return "; name it with --glass " + name + "=n_d,V_d, or glass={\"" + name + "\": (n_d, V_d)} in Python";
}

}  // namespace

Glass LensGlasses::find(const std::string& name, const std::vector<std::string>& catalogues, const std::string& hint) {
    asked_.insert(name);
    for (const auto& [given, glass] : options_.glasses)
        if (bare_glass_name(given) == bare_glass_name(name)) {
            used_.insert(given);
            Glass found = glass;
            if (found.label.empty()) found.label = name;
            return found;
        }
    if (const auto own = own_.find(name); own != own_.end()) return own->second;
    const std::string quoted = in_quotes(name);
    if (bare_glass_name(name).empty()) throw InputError("a glass has no name");
    std::vector<CatalogueName> all = catalogue_names_like(name), found;
    for (const CatalogueName& one : all) {
        const bool allowed = catalogues.empty() || std::any_of(catalogues.begin(), catalogues.end(),
                                                               [&](const auto& c) { return maker_of(c) == one.maker; });
        if (allowed) found.push_back(one);
    }
    const auto names_of = [](const std::vector<CatalogueName>& list) {
        std::vector<std::string> names;
        for (const CatalogueName& one : list) names.push_back(one.full());
        return names;
    };
    if (!found.empty()) {
        const Glass first = catalogued(found.front());
        const bool alike = std::all_of(found.begin(), found.end(), [&](const CatalogueName& one) {
            return same_indices(first, catalogue_glass(one.full()));
        });
        if (alike) return first;
        throw InputError("the glass name " + quoted + " stands for several glasses: " + listed(names_of(found)) +
                         "; one of them is wanted, as in --glass " + name + '=' + found.front().full() +
                         ", or glass={\"" + name + "\": \"" + found.front().full() + "\"} in Python");
    }
    std::string message = "unknown glass " + quoted;
    if (!catalogues.empty()) message += " of the catalogue" + std::string(catalogues.size() > 1 ? "s " : " ");
    if (!catalogues.empty()) message += listed(catalogues);
    if (!all.empty())
        message += ", which other catalogues have: " + listed(names_of(all));
    else
        message += did_you_mean(name, catalogue_plain_names());
    throw InputError(message + (hint.empty() ? "" : "; the file says of it " + hint) + how_to_settle(name));
}

void LensGlasses::check_all_used() const {
    for (const auto& [given, glass] : options_.glasses)
        if (!used_.contains(given))
            throw InputError("the lens file has no glass " + in_quotes(given) + "; " +
                             (asked_.empty() ? "it names none" : "it names " + listed({asked_.begin(), asked_.end()})));
}

std::optional<CatalogueName> catalogue_name_of(const Glass& glass) {
    try {
        if (!(catalogue_glass(glass.label) == glass)) return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
    const std::size_t colon = glass.label.find(':');
    for (const CatalogueName& one :
         catalogue_names_like(glass.label.substr(colon == std::string::npos ? 0 : colon + 1)))
        if (colon == std::string::npos || one.full() == glass.label) return one;
    return std::nullopt;
}

AbbePair abbe_pair(const Glass& glass) {
    const double n_d = glass.index(kLineD_nm), spread = glass.index(kLineF_nm) - glass.index(kLineC_nm);
    return {n_d, glass.has_one_index() || spread == 0 ? 0.0 : (n_d - 1) / spread};
}

Glass glass_of_pair(double n_d, double v_d) {
    if (!(n_d >= 1) || !(n_d < 10)) throw InputError("the index n_d must lie between 1 and 10");
    if (!(v_d >= 0)) throw InputError("the Abbe number V_d must be positive, or 0 for a glass without dispersion");
    Glass glass = v_d == 0 ? Glass::constant(n_d) : Glass::from_abbe_number(n_d, v_d);
    glass.label = v_d == 0 ? number_label(n_d) : number_label(n_d) + " / " + number_label(v_d);
    return n_d == 1 && v_d == 0 ? Glass::air() : glass;
}

std::pair<std::string, Glass> named_glass(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == text.npos || name.empty())
        throw InputError("--glass: " + in_quotes(text) + ": NAME=n_d,V_d or NAME=MAKER:GLASS is wanted");
    std::string_view rest = std::string_view(text).substr(equals + 1);
    const std::optional<double> n_d = take_number(rest);
    if (!n_d) return {name, catalogue_glass(std::string(rest))};
    double v_d = 0;
    if (rest.starts_with(',')) {
        rest.remove_prefix(1);
        const std::optional<double> value = take_number(rest);
        if (!value || !(*value > 0)) rest = "?";
        v_d = value.value_or(0);
    }
    if (!rest.empty() || !std::isfinite(*n_d) || !std::isfinite(v_d))
        throw InputError("--glass: " + in_quotes(text) +
                         ": NAME=n_d,V_d is wanted, as in CAF2=1.4338,95.1, or NAME=n where it has no dispersion");
    return {name, glass_of_pair(*n_d, v_d)};
}

}  // namespace realcam::io
