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

    /// "schott:N-BK7"
    std::string full() const { return maker + ':' + name; }
};

/// Normalises a name for comparison: upper case, without hyphens, underscores and blanks, which programs write
/// differently.
std::string bare_glass_name(std::string_view name);

/// Returns all glasses of this name, ignoring case, hyphens and blanks, in which programs differ.
std::vector<CatalogueName> catalogue_names_like(std::string_view name);
/// Returns the catalogue's name of a glass if it equals the glass that its label names; otherwise std::nullopt.
std::optional<CatalogueName> catalogue_name_of(const Glass& glass);
/// Returns all glasses of the catalogue with their makers, such as "schott:N-BK7", sorted by plain name.
std::vector<std::string> catalogue_full_names();
/// Returns all glass names of the catalogue without their makers, each once, for suggestions.
std::vector<std::string> catalogue_plain_names();

/// Finds glasses by the names in another program's file. An unknown or ambiguous name is an error: a substitute, or a
/// glass of another maker's catalogue, would silently give a wrong lens.
class LensGlasses {
public:
    explicit LensGlasses(const LensReadOptions& options) : options_(options) {}

    const LensReadOptions& options() const { return options_; }

    /// Adds a glass that the lens file itself defines.
    void define(const std::string& name, Glass glass) { file_glasses_.insert_or_assign(name, std::move(glass)); }

    /// Returns the glass of a name. `catalogues`: those that the file lists, by its names; empty: any. A name of six
    /// digits that no catalogue has is the glass of that number (see glass_of_number). `hint`: further data of the
    /// glass in the file, for the message. Throws UnknownGlass with the candidates.
    Glass find(const std::string& name, const std::vector<std::string>& catalogues, const std::string& hint = {});
    /// Returns a substance of refractiveindex.info, shelf "main", by its book and page, such as "CaF2" and "Daimon-20".
    /// If the page is unknown, another page of the book is used, and a warning is appended to `remarks`. Throws
    /// UnknownGlass if the book is unknown.
    Glass substance(const std::string& book, const std::string& page, std::vector<std::string>& remarks);
    /// Returns the glass of a name if the catalogues have exactly one, and the options, the file and the user's
    /// catalogue do not define it; otherwise std::nullopt.
    std::optional<Glass> in_catalogue(const std::string& name, const std::vector<std::string>& catalogues) const;
    /// True if the options (LensReadOptions::glasses) specify the glass of this name.
    bool has_user_glass(const std::string& name) const;

    /// Throws InputError if the options specify a glass that the file does not use.
    void check_all_used() const;

private:
    const LensReadOptions& options_;
    std::map<std::string, Glass> file_glasses_;  ///< defined by the lens file, by name
    std::set<std::string> requested_;  ///< names that the lens file uses
    std::set<std::string> used_;  ///< names in the options' glasses that were used
};

/// n_d and V_d of a glass; V_d is 0 if it has the same index at all wavelengths.
struct AbbePair {
    double n_d, v_d;
};
/// Returns n_d and V_d of a glass from its indices at the lines d, F and C.
AbbePair abbe_pair(const Glass& glass);

/// Returns n_d and V_d of a glass code: 517642 is n_d = 1.517 and V_d = 64.2, as in MIL-G-174. std::nullopt if the name
/// is not six digits.
std::optional<AbbePair> glass_of_number(std::string_view name);

/// Tabulates a glass from a formula. `index`: refractive index by wavelength in um. The table has steps of 10 nm,
/// between which the index is off by less than 1e-7. It covers the wavelengths from 0.3 to 15 um at which the formula
/// has an index from 1 to
/// 10. Throws InputError if it has no such index in the visible.
Glass glass_of_formula(const std::function<double(double)>& index, std::string label);

/// Returns a glass with this n_d and V_d, and a label that states both. A V_d of 0 means no dispersion. Throws
/// InputError.
Glass glass_of_pair(double n_d, double v_d);

}  // namespace realcam::io
