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

/// A glass of the catalogue by maker and name: "schott", "N-BK7".
struct CatalogueName {
    std::string maker, name;

    std::string full() const { return maker + ':' + name; }
};

/// A name as it is compared: in capital letters, without what other programs leave out or write otherwise, hyphens and
/// blanks.
std::string bare_glass_name(std::string_view name);

/// All whose name is this one without regard to case, hyphens and blanks, as other programs spell it.
std::vector<CatalogueName> catalogue_names_like(std::string_view name);
/// The catalogue's name of a glass that is exactly the one its label names; nothing where it is none.
std::optional<CatalogueName> catalogue_name_of(const Glass& glass);
/// Every glass of the catalogue with its maker, "schott:N-BK7", by plain name.
std::vector<std::string> catalogue_full_names();
/// Every name of the catalogue, for suggestions.
std::vector<std::string> catalogue_plain_names();

/// Glasses as another program's file names them. What is not known exactly is an error: a glass that is taken from
/// another maker's catalogue, or replaced, spoils a lens in silence.
class LensGlasses {
public:
    explicit LensGlasses(const LensReadOptions& options) : options_(options) {}

    const LensReadOptions& options() const { return options_; }

    /// A glass that the file itself defines.
    void define(const std::string& name, Glass glass) { own_.insert_or_assign(name, std::move(glass)); }

    /// `catalogues`: those that the file lists, in its words; empty: any. A name of six digits that no catalogue has is
    /// the glass of that number (see glass_of_number). `hint`: what the file says of it besides.
    /// Throws UnknownGlass with the candidates.
    Glass find(const std::string& name, const std::vector<std::string>& catalogues, const std::string& hint = {});
    /// A substance of the shelf "main" of refractiveindex.info by book and page, "CaF2", "Daimon-20". No maker's glass
    /// is meant by such a name. Where the page is not known, another one of the book is taken, with a line in
    /// `remarks`. Throws UnknownGlass.
    Glass substance(const std::string& book, const std::string& page, std::vector<std::string>& remarks);
    /// Whether one of the catalogues has exactly one glass of that name, and nobody has named another one for it.
    std::optional<Glass> in_catalogue(const std::string& name, const std::vector<std::string>& catalogues) const;
    /// Whether the options say what glass that is.
    bool is_given(const std::string& name) const;

    /// Throws InputError where the options name a glass that the file did not ask for.
    void check_all_used() const;

private:
    const LensReadOptions& options_;
    std::map<std::string, Glass> own_;
    std::set<std::string> asked_, used_;
};

/// n_d and V_d of a glass; V_d is 0 where it has one index at all wavelengths.
struct AbbePair {
    double n_d, v_d;
};
AbbePair abbe_pair(const Glass& glass);

/// n_d and V_d of a glass that is called by its number: 517642 is n_d = 1.517 and V_d = 64.2, as in MIL-G-174. Nothing
/// where the name is not six digits.
std::optional<AbbePair> glass_of_number(std::string_view name);

/// A glass as a table of a formula for n, by wavelength in um. The table has steps of 10 nm, between which the index is
/// off by less than 1e-7. It covers the wavelengths from 0.3 to 15 um at which the formula has an index from 1 to 10.
/// Throws InputError where it has none in the visible.
Glass glass_of_formula(const std::function<double(double)>& index, std::string label);

/// A glass from n_d and V_d, with a label that says both. A V_d of 0 means no dispersion. Throws InputError.
Glass glass_of_pair(double n_d, double v_d);

}  // namespace realcam::io
