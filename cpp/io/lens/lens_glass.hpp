#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lens_error.hpp"
#include "lens_file.hpp"

namespace realcam::io {

/// Name of a glass in the catalogue: maker and name, such as "schott" and "N-BK7".
struct CatalogueName {
    std::string maker, name;

    std::string full() const { return maker + ':' + name; }
};

/// Normalises a name for comparison: upper case, without hyphens, underscores and blanks, which programs write
/// differently.
std::string bare_glass_name(std::string_view name);

/// Returns all glasses of this name, ignoring case, hyphens and blanks, in which programs differ.
std::vector<CatalogueName> catalogue_names_like(std::string_view name);
/// Returns the catalogue's name of a glass if it equals the glass that its label names; otherwise std::nullopt.
std::optional<CatalogueName> catalogue_name_of(const Glass& glass);
/// Returns every glass of the catalogue with its maker, "schott:N-BK7", by plain name.
std::vector<std::string> catalogue_full_names();
/// Returns every name of the catalogue, for suggestions.
std::vector<std::string> catalogue_plain_names();

/// Finds glasses by the names in another program's file. An unknown or ambiguous name is an error: a glass that is
/// taken from another maker's catalogue, or replaced, would spoil a lens silently.
class LensGlasses {
public:
    explicit LensGlasses(const LensReadOptions& options) : options_(options) {}

    const LensReadOptions& options() const { return options_; }

    /// Adds a glass that the file itself defines.
    void define(const std::string& name, Glass glass) { own_.insert_or_assign(name, std::move(glass)); }

    /// Returns the glass of a name. `catalogues`: those that the file lists, by its names; empty: any. A name of six
    /// digits that no catalogue has is the glass of that number (see glass_of_number). `hint`: additional data in the
    /// file, for the message. Throws UnknownGlass with the candidates.
    Glass find(const std::string& name, const std::vector<std::string>& catalogues, const std::string& hint = {});
    /// Returns a substance of the shelf "main" of refractiveindex.info by book and page, "CaF2", "Daimon-20"; such
    /// names are not those of a maker's glass. If the page is not known, another one of the book is taken, with a line
    /// in `remarks`. Throws UnknownGlass.
    Glass substance(const std::string& book, const std::string& page, std::vector<std::string>& remarks);
    /// Returns the glass of a name if the catalogues have exactly one, and the options, the file and the user's
    /// catalogue do not define it; otherwise std::nullopt.
    std::optional<Glass> in_catalogue(const std::string& name, const std::vector<std::string>& catalogues) const;
    /// True if the options specify the glass of this name.
    bool is_given(const std::string& name) const;

    /// Throws InputError if the options specify a glass that the file does not use.
    void check_all_used() const;

private:
    const LensReadOptions& options_;
    std::map<std::string, Glass> own_;
    std::set<std::string> requested_, used_;
};

/// n_d and V_d of a glass; V_d is 0 if it has the same index at all wavelengths.
struct AbbePair {
    double n_d, v_d;
};
AbbePair abbe_pair(const Glass& glass);

/// Returns n_d and V_d of a glass code: 517642 is n_d = 1.517 and V_d = 64.2, as in MIL-G-174. std::nullopt if the name
/// is not six digits.
std::optional<AbbePair> glass_of_number(std::string_view name);

/// Tabulates a glass from a formula for n, by wavelength in um. The table has steps of 10 nm, between which the index
/// is off by less than 1e-7. It covers the wavelengths from 0.3 to 15 um at which the formula has an index from 1 to
/// 10. Throws InputError if it has no such index in the visible.
Glass glass_of_formula(const std::function<double(double)>& index, std::string label);

/// Makes a glass from n_d and V_d, with a label that states both. A V_d of 0 means no dispersion. Throws InputError.
Glass glass_of_pair(double n_d, double v_d);

}  // namespace realcam::io
