// The bundled glass catalogue, and glasses in realcam's own lens files.

#include <map>
#include <set>

#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_material.hpp"
#include "lens_text.hpp"

namespace realcam::io {
namespace {

constexpr std::string_view kCatalogueFile = "lenses/glass.toml";

const toml::table& catalogue() {
    static const toml::table table = toml::parse(bundled_glass_catalogue(), kCatalogueFile);
    return table;
}

/// Returns qualified names ("schott:N-BK7") by plain name.
const std::multimap<std::string, std::string>& qualified_names() {
    static const std::multimap<std::string, std::string> map = [] {
        std::multimap<std::string, std::string> all;
        for (const auto& [maker, glasses] : catalogue())
            if (const toml::table* table = glasses.as_table())
                for (const auto& [name, glass] : *table)
                    all.emplace(std::string(name.str()), std::string(maker.str()) + ':' + std::string(name.str()));
        return all;
    }();
    return map;
}

/// Returns catalogue names by bare name.
const std::multimap<std::string, CatalogueName>& bare_names() {
    static const std::multimap<std::string, CatalogueName> map = [] {
        std::multimap<std::string, CatalogueName> all;
        for (const auto& [plain, full] : qualified_names())
            all.emplace(bare_glass_name(plain), CatalogueName{full.substr(0, full.find(':')), plain});
        return all;
    }();
    return map;
}

/// Returns the glass of a qualified name, "schott:N-BK7". Throws InputError.
Glass qualified_glass(const std::string& name) {
    const std::size_t colon = name.find(':');
    const toml::table* maker = catalogue()[name.substr(0, colon)].as_table();
    const toml::node* glass = maker ? maker->get(name.substr(colon + 1)) : nullptr;
    if (!glass) throw InputError("unknown glass \"" + name + '"' + did_you_mean(name, catalogue_full_names()));
    return glass_from_table(TomlTable(*glass->as_table(), std::string(kCatalogueFile)));
}

}  // namespace

std::string bare_glass_name(std::string_view name) {
    std::string out;
    for (const char c : name)
        if (c != '-' && c != '_' && c != ' ') out += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    return out;
}

std::vector<CatalogueName> catalogue_names_like(std::string_view name) {
    std::vector<CatalogueName> found;
    const auto [first, last] = bare_names().equal_range(bare_glass_name(name));
    for (auto it = first; it != last; ++it) found.push_back(it->second);
    return found;
}

std::vector<std::string> catalogue_full_names() {
    std::vector<std::string> all;
    for (const auto& [plain, full] : qualified_names()) all.push_back(full);
    return all;
}

std::vector<std::string> catalogue_plain_names() {
    std::vector<std::string> all;
    for (const auto& [plain, full] : qualified_names())
        if (all.empty() || all.back() != plain) all.push_back(plain);
    return all;
}

Glass glass_from_table(const TomlTable& table) {
    table.allow({"n_d", "V_d", "sellmeier", "cauchy", "table", "index", "label"});
    const auto index = table.number("index"), n_d = table.number("n_d"), v_d = table.number("V_d");
    const auto sellmeier = table.table("sellmeier");
    const std::vector<double> cauchy = table.numbers("cauchy", 0);
    const toml::node* points = table.find("table");
    const int specified =
        index.has_value() + (n_d || v_d) + sellmeier.has_value() + !cauchy.empty() + (points != nullptr);
    if (specified != 1) table.fail("a glass needs exactly one of: n_d with V_d, sellmeier, cauchy, table, index");
    if (index) return Glass::constant(*index);
    if (!cauchy.empty()) return Glass::cauchy(cauchy);
    if (sellmeier) {
        sellmeier->allow({"B", "C"});
        const std::vector<double> b = sellmeier->numbers("B", 0), c = sellmeier->numbers("C", 0);
        if (b.empty() || b.size() != c.size()) sellmeier->fail("sellmeier needs B and C with equally many numbers");
        std::vector<Glass::SellmeierTerm> terms;
        for (std::size_t i = 0; i < b.size(); ++i) terms.push_back({b[i], c[i]});
        return Glass::sellmeier(terms);
    }
    if (points) {
        std::vector<Glass::TablePoint> list;
        const toml::array* rows = points->as_array();
        if (!rows || rows->empty()) table.fail("\"table\" must be an array of [wavelength in nm, index]", points);
        if (rows->size() > kMaxFileIndices)
            table.fail("\"table\" has " + std::to_string(rows->size()) + " rows; at most " +
                           std::to_string(kMaxFileIndices) + " are read",
                       points);
        std::set<double> wavelengths;
        for (const toml::node& row : *rows) {
            const toml::array* pair = row.as_array();
            if (!pair || pair->size() != 2) table.fail("each row of \"table\" must be [wavelength in nm, index]", &row);
            list.push_back({table.as_number((*pair)[0], "a wavelength"), table.as_number((*pair)[1], "an index")});
            if (!wavelengths.insert(list.back().wavelength_nm).second)
                table.fail("\"table\" contains a wavelength twice", &row);
            if (!(list.back().wavelength_nm > 0)) table.fail("wavelengths are positive numbers, in nm", &row);
        }
        return Glass::table(std::move(list));
    }
    if (!n_d || !v_d) table.fail("n_d and V_d must be specified together");
    if (!(*n_d >= 1)) table.fail("the index n_d must be at least 1", table.find("n_d"));
    if (!(*v_d > 0)) table.fail("the Abbe number V_d must be positive", table.find("V_d"));
    return Glass::from_abbe_number(*n_d, *v_d);
}

Glass catalogue_glass(const std::string& name) {
    std::string full = name;
    if (name.find(':') == std::string::npos) {
        const auto [first, last] = qualified_names().equal_range(name);
        if (first == last)
            throw InputError("unknown glass \"" + name + '"' + did_you_mean(name, catalogue_plain_names()));
        if (std::next(first) != last) {
            std::string choices;
            for (auto it = first; it != last; ++it) choices += (choices.empty() ? "\"" : ", \"") + it->second + '"';
            throw InputError("the glass name \"" + name + "\" is in several catalogues; specify one of " + choices);
        }
        full = first->second;
    }
    Glass glass = qualified_glass(full);
    glass.label = name;
    return glass;
}

}  // namespace realcam::io
