#include "lens_glass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../text/help_page.hpp"
#include "../text/printable.hpp"
#include "../text/text_number.hpp"
#include "lens_material.hpp"
#include "lens_text.hpp"

namespace realcam::io {
namespace {

/// Returns the maker in realcam's catalogue that corresponds to a catalogue name of another program, such as "SCHOTT",
/// "SUMITA_AUG2011", "NIKON-HIKARI" or "MISC"; empty if it is unknown.
std::string maker_of_catalogue(const std::string& catalogue) {
    const std::string word = upper_case(catalogue);
    for (const char* maker : {"schott", "ohara", "hoya", "cdgm", "hikari", "sumita"})
        if (word.find(upper_case(maker)) != std::string::npos) return maker;
    if (word == "NIKON") return "hikari";
    // Catalogues of other programs with materials that are not those of a glass maker.
    for (const char* mixed : {"MISC", "SPECIAL", "INFRARED", "PLASTIC", "PLASTICS", "ZEON", "ZEONEX", "POLYMER"})
        if (word == mixed) return "misc";
    return {};
}

/// True if two glasses have the same indices, to the digits of the makers' tables.
bool same_indices(const Glass& a, const Glass& b) {
    for (double nm = 400; nm <= 700; nm += 25)
        if (std::fabs(a.index(nm) - b.index(nm)) > 1e-6) return false;
    return true;
}

/// Returns a glass of the catalogue, labelled with its maker only if several makers use the name.
Glass glass_of(const CatalogueName& found) {
    const bool is_unique = catalogue_names_like(found.name).size() == 1;
    return catalogue_glass(is_unique ? found.name : found.full());
}

/// Returns the names that are in one of the catalogues listed in a file; all names if it lists none.
std::vector<CatalogueName> in_listed_catalogues(const std::vector<CatalogueName>& all,
                                                const std::vector<std::string>& catalogues) {
    if (catalogues.empty()) return all;
    std::vector<CatalogueName> found;
    for (const CatalogueName& candidate : all)
        if (std::any_of(catalogues.begin(), catalogues.end(),
                        [&](const auto& c) { return maker_of_catalogue(c) == candidate.maker; }))
            found.push_back(candidate);
    return found;
}

/// True if all these glasses have the same indices as `first`.
bool all_have_same_indices(const std::vector<CatalogueName>& found, const Glass& first) {
    return std::all_of(found.begin(), found.end(), [&](const CatalogueName& candidate) {
        return same_indices(first, catalogue_glass(candidate.full()));
    });
}

}  // namespace

bool LensGlasses::has_user_glass(const std::string& name) const {
    return std::any_of(options_.glasses.begin(), options_.glasses.end(),
                       [&](const auto& entry) { return bare_glass_name(entry.first) == bare_glass_name(name); });
}

std::optional<Glass> LensGlasses::in_catalogue(const std::string& name,
                                               const std::vector<std::string>& catalogues) const {
    if (has_user_glass(name) || file_glasses_.contains(name) || options_.catalogue.contains(bare_glass_name(name)))
        return {};
    const std::vector<CatalogueName> found = in_listed_catalogues(catalogue_names_like(name), catalogues);
    if (found.empty()) return {};
    Glass first = glass_of(found.front());
    if (!all_have_same_indices(found, first)) return {};
    return first;
}

Glass LensGlasses::find(const std::string& name, const std::vector<std::string>& catalogues, const std::string& hint) {
    requested_.insert(name);
    for (const auto& [user_name, glass] : options_.glasses)
        if (bare_glass_name(user_name) == bare_glass_name(name)) {
            used_.insert(user_name);
            Glass found = glass;
            if (found.label.empty()) found.label = name;
            return found;
        }
    if (const auto own = file_glasses_.find(name); own != file_glasses_.end()) return own->second;
    if (const auto found = options_.catalogue.find(bare_glass_name(name)); found != options_.catalogue.end())
        return found->second;
    const std::string quoted = in_quotes(name);
    if (bare_glass_name(name).empty()) throw InputError("a glass has no name");
    const std::vector<CatalogueName> all = catalogue_names_like(name), found = in_listed_catalogues(all, catalogues);
    if (all.empty())
        if (const std::optional<AbbePair> number = glass_of_number(name))
            return glass_of_pair(number->n_d, number->v_d);
    const auto names_of = [](const std::vector<CatalogueName>& list) {
        std::vector<std::string> names;
        for (const CatalogueName& candidate : list) names.push_back(candidate.full());
        return names;
    };
    if (!found.empty()) {
        Glass first = glass_of(found.front());
        if (all_have_same_indices(found, first)) return first;
        throw UnknownGlass("the glass name " + quoted + " stands for several glasses: " + quoted_list(names_of(found)) +
                               "; specify one of them",
                           name, found.front().full());
    }
    std::string message = "unknown glass " + quoted;
    if (!catalogues.empty()) message += " of the catalogue" + std::string(catalogues.size() > 1 ? "s " : " ");
    if (!catalogues.empty()) message += quoted_list(catalogues);
    if (!all.empty())
        message += ", which other catalogues have: " + quoted_list(names_of(all));
    else
        message += did_you_mean(name, catalogue_plain_names());
    throw UnknownGlass(message + (hint.empty() ? "" : "; the file states " + hint) + "; specify its n_d and V_d", name);
}

Glass LensGlasses::substance(const std::string& book, const std::string& page, std::vector<std::string>& remarks) {
    struct Page {
        const char *book, *page, *name;  ///< `name`: in realcam's catalogue, maker "misc"
    };
    // The first page of a book stands for unknown pages.
    static constexpr Page kPages[] = {
        {"Al2O3", "Malitson-o", "SAPPHIRE"},
        {"BaF2", "Malitson", "BAF2-MALITSON"},
        {"BaF2", "Li", "BAF2-LI"},
        {"CaF2", "Malitson", "CAF2"},
        {"CaF2", "Daimon-20", "CAF2-DAIMON-20"},
        {"CaF2", "Daimon-25", "CAF2-DAIMON-25"},
        {"CaF2", "Li", "CAF2-LI"},
        {"LiF", "Li", "LIF"},
        {"MgF2", "Dodge-o", "MGF2"},
        {"MgF2", "Li-o", "MGF2-LI-O"},
        {"SiO2", "Malitson", "SILICA"},
        {"ZnS", "Debenham", "ZNS"},
        {"ZnS", "Querry", "ZNS-QUERRY"},
        {"ZnSe", "Marple", "ZNSE"},
        {"ZnSe", "Connolly", "ZNSE-CONNOLLY"},
    };
    if (has_user_glass(book)) return find(book, {});
    requested_.insert(book);
    const Page* found = nullptr;
    for (const Page& candidate : kPages)
        if (upper_case(candidate.book) == upper_case(book) &&
            (!found || upper_case(candidate.page) == upper_case(page)))
            found = &candidate;
    if (!found)
        throw UnknownGlass("unknown substance " + in_quotes(book) + " of refractiveindex.info; specify its n_d and V_d",
                           book);
    if (upper_case(found->page) != upper_case(page)) {
        char n_d[32];
        std::snprintf(n_d, sizeof n_d, "%.5f", catalogue_glass("misc:" + std::string(found->name)).index(kLineD_nm));
        remarks.push_back("the page " + in_quotes(page) + " of " + found->book +
                          " of refractiveindex.info is unknown; " + found->page + " is used instead, n_d = " + n_d +
                          "; how much they differ is unknown");
    }
    Glass glass = catalogue_glass("misc:" + std::string(found->name));
    return glass;
}

void LensGlasses::check_all_used() const {
    for (const auto& [user_name, glass] : options_.glasses)
        if (!used_.contains(user_name))
            throw InputError("the lens file has no glass " + in_quotes(user_name) + "; " +
                             (requested_.empty() ? "it names none"
                                                 : "it names " + quoted_list({requested_.begin(), requested_.end()})));
}

std::optional<CatalogueName> catalogue_name_of(const Glass& glass) {
    try {
        if (!(catalogue_glass(glass.label) == glass)) return std::nullopt;
    } catch (const InputError&) {
        return std::nullopt;
    }
    const std::size_t colon = glass.label.find(':');
    for (const CatalogueName& candidate :
         catalogue_names_like(glass.label.substr(colon == std::string::npos ? 0 : colon + 1)))
        if (colon == std::string::npos || candidate.full() == glass.label) return candidate;
    return std::nullopt;
}

AbbePair abbe_pair(const Glass& glass) {
    const double n_d = glass.index(kLineD_nm), spread = glass.index(kLineF_nm) - glass.index(kLineC_nm);
    return {n_d, glass.has_one_index() || spread == 0 ? 0.0 : (n_d - 1) / spread};
}

std::optional<AbbePair> glass_of_number(std::string_view name) {
    if (name.size() != 6 || name.find_first_not_of("0123456789") != name.npos) return {};
    const auto digits = [&](std::size_t from) {
        return static_cast<double>(std::stoi(std::string(name.substr(from, 3))));
    };
    return AbbePair{1 + digits(0) / 1000, digits(3) / 10};
}

Glass glass_of_formula(const std::function<double(double)>& index, std::string label) {
    std::vector<Glass::TablePoint> points;
    bool has_visible = false;
    for (double nm = 300; nm <= 15000; nm += nm < 2500 ? 10 : 50) {
        const double n = index(nm / 1000);
        const bool is_index = n >= 1 && n < 10;  // false for NaN
        // Uses the contiguous range of wavelengths that contains the visible; beyond a gap the formula is not valid.
        if (!is_index && has_visible) break;
        if (!is_index) points.clear();
        if (is_index) points.push_back({nm, n});
        has_visible = has_visible || (is_index && nm >= 580);
    }
    if (!has_visible || points.front().wavelength_nm > 580)
        throw InputError("the formula of the glass " + in_quotes(label) + " gives no index from 1 to 10 at 580 nm");
    Glass glass = Glass::table(std::move(points));
    glass.label = std::move(label);
    return glass;
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
        throw InputError(in_quotes(text) + ": expected NAME=n_d,V_d or NAME=MAKER:GLASS");
    std::string_view rest = std::string_view(text).substr(equals + 1);
    const std::optional<double> n_d = consume_number(rest);
    if (!n_d) return {name, catalogue_glass(std::string(rest))};
    double v_d = 0;
    if (rest.starts_with(',')) {
        rest.remove_prefix(1);
        const std::optional<double> value = consume_number(rest);
        if (!value || !(*value > 0)) rest = "?";
        v_d = value.value_or(0);
    }
    if (!rest.empty() || !std::isfinite(*n_d) || !std::isfinite(v_d))
        throw InputError(in_quotes(text) +
                         ": expected NAME=n_d,V_d, as in CAF2=1.4338,95.1, or NAME=n for a glass without dispersion");
    return {name, glass_of_pair(*n_d, v_d)};
}

}  // namespace realcam::io
