#pragma once
#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../lens_glass.hpp"
#include "../lens_prescription.hpp"
#include "../lens_text.hpp"

namespace realcam::io {

/// Greatest surface number that is parsed in a command, and greatest number of a wavelength.
inline constexpr int kMaxSurfaceNumber = 1 << 20, kMaxWavelengths = 1000;

/// Base of the readers of other programs' lens files: the prescription, and the rules that all formats share.
class PrescriptionReader {
protected:
    PrescriptionReader(const char* format, const std::string& file, LensGlasses& glasses);

    /// Throws LensFileError at a line and surface of the file; 0: unknown.
    [[noreturn]] void fail_at(const std::string& message, int line = 0, int surface = 0) const {
        throw LensFileError(message, p_.file, line, surface);
    }
    /// Records a feature that realcam does not model, once for each surface. `description`: a noun phrase.
    void add_unsupported(const std::string& description, int line, int surface);
    /// Adds a warning for the user, unless the same text was added before.
    void remark(const std::string& text);

    /// Sets the object distance in mm, and records a curved object surface as unsupported. Distances from kLongest on
    /// mean infinity in all formats.
    void set_object(double distance, double curvature, int line);
    /// Sets the wavelengths, and the design wavelength to the one at index `main`. An empty list: the d line.
    void set_wavelengths(std::vector<double> wavelengths_nm, std::size_t main);

    Prescription p_;  ///< the result
    LensGlasses& glasses_;

private:
    std::set<std::pair<std::string, int>> unsupported_;  ///< descriptions recorded so far, with their surfaces
    std::set<std::string> remarks_;  ///< texts added so far
};

/// Command of a text file: its keyword in capitals, and the values behind it. Every error is a LensFileError that names
/// the line. Indices of values begin at 0.
class LensCommand {
public:
    LensCommand(const LensLines& lines, std::string word, std::vector<LensWord> values)
        : word(std::move(word)), lines_(lines), values_(std::move(values)) {}

    std::string word;
    std::string description;  ///< the description in the table of keywords (Keywords::Row)

    /// The number of values.
    std::size_t size() const { return values_.size(); }
    const LensWord& operator[](std::size_t i) const { return values_[i]; }
    /// Removes the first value.
    void remove_first() { values_.erase(values_.begin()); }
    /// Returns value i in capitals, truncated to `max_length` characters; empty if the value is absent.
    std::string upper(std::size_t i, std::size_t max_length = std::string_view::npos) const;

    // Parse value i. `name`: noun phrase for the value, which begins the error message. Missing or invalid values are
    // errors.

    /// Returns a finite number.
    double number(std::size_t i, const std::string& name) const;
    /// Returns a finite number, or `default_value` if the value is absent or a text in quotes.
    double number_or(std::size_t i, const std::string& name, double default_value) const;
    /// Returns a number, which may be infinite.
    double number_or_infinity(std::size_t i, const std::string& name) const;
    /// Returns all values from index `first` on as finite numbers.
    std::vector<double> numbers(std::size_t first, const std::string& name) const;
    /// Returns a whole number from `min` to `max`.
    int whole(std::size_t i, const std::string& name, int min, int max) const;

private:
    const LensLines& lines_;
    std::vector<LensWord> values_;
};

/// Table of a format's keywords with the functions that read their commands. A row may have several keywords, separated
/// by blanks, with the same function. Keywords of a row without a function are ignored.
template <class Reader>
class Keywords {
public:
    using Function = void (*)(Reader&, LensCommand&);
    struct Row {
        std::string_view keywords;
        Function read = nullptr;
        std::string_view description = {};  ///< noun phrase for the feature, for messages
    };

    Keywords(std::initializer_list<Row> rows) {
        for (const Row& row : rows)
            for (std::size_t begin = 0; begin < row.keywords.size();) {
                const std::size_t end = std::min(row.keywords.find(' ', begin), row.keywords.size());
                rows_.emplace(row.keywords.substr(begin, end - begin), row);
                begin = end + 1;
            }
    }

    /// Returns the row of a keyword; null if the format does not have it.
    const Row* find(std::string_view word) const {
        const auto found = rows_.find(word);
        return found == rows_.end() ? nullptr : &found->second;
    }

    /// Calls the function of a command's keyword, if it has one. Returns false if the table does not have the keyword.
    bool read(Reader& reader, LensCommand& command) const {
        const Row* row = find(command.word);
        if (row) command.description = row->description;
        if (row && row->read) row->read(reader, command);
        return row;
    }

private:
    std::map<std::string_view, Row> rows_;
};

/// Base of the readers of text files, which consist of lines of commands.
class PrescriptionText : protected PrescriptionReader {
public:
    PrescriptionText(const char* format, std::string_view text, const std::string& file, LensGlasses& glasses)
        : PrescriptionReader(format, file, glasses), lines_(text, file, glasses.options().keep_going) {}

protected:
    /// Records a feature that realcam does not model, at the current line and surface.
    void unsupported(const std::string& description) {
        add_unsupported(description, lines_.number(), lines_.surface());
    }
    /// Records the feature of a command, by its description and keyword.
    void unsupported(const LensCommand& command) { unsupported(command.description + " (" + command.word + ")"); }
    /// Adds a warning that the feature of a command is left out.
    void remark_omission(const LensCommand& command) { remark(command.description + " (" + command.word + ")"); }
    /// Records an unknown keyword for remark_unknown_keywords.
    void add_unknown_keyword(std::string_view word);
    /// Adds one warning that names the unknown keywords, if there are any. `subject`: plural noun for them, such as
    /// "commands".
    void remark_unknown_keywords(const std::string& subject);
    /// Returns all values of a command, one per field point.
    std::vector<double> field_values(const LensCommand& command) const;
    /// Throws LensFileError if a surface after `surfaces` others would exceed kMaxFileSurfaces.
    void check_count(std::size_t surfaces) const;

    LensLines lines_;

private:
    std::set<std::string> unknown_;
};

/// Returns the length in mm of a unit such as "MM" or "INCH"; std::nullopt if the unit is unknown.
std::optional<double> millimetres_of(const std::string& unit);

/// Returns the curvature in 1/mm for a radius in units of `unit` mm. A radius of 0 means a plane.
inline double curvature_of(double radius, double unit = 1) {
    return radius == 0 ? 0.0 : 1 / (unit * radius);
}

/// Adds a term of the sag, value r^power, with sag and r in units of `unit` mm.
void add_term(PrescriptionSurface& row, int power, double value, double unit = 1);

/// Returns the powers of x and y of term `number` in the sequence x, y, x^2, x y, y^2, ..., which begins at 1.
std::pair<int, int> xy_powers(int number);

/// Sets the Zernike terms of a row, unless all of them are 0. `radius`: normalisation radius in mm. `coefficients` in
/// mm.
void set_zernike(PrescriptionSurface& row, ZernikeOrder order, double radius, std::vector<double> coefficients);

/// Clamps a vignetting factor, the fraction of the pupil's radius that is cut off, to 0 to 0.999.
inline double vignetting(double value) {
    return std::clamp(value, 0.0, 0.999);
}

/// Returns element i of a list; 0 beyond its end.
inline double element_or_0(const std::vector<double>& list, std::size_t i) {
    return i < list.size() ? list[i] : 0.0;
}

/// Sets the outline of an aperture: a circle or a rectangle if the flag is set, otherwise an ellipse. `half`:
/// half-widths in x and y, `offset`: centre, both in mm.
void set_outline(ApertureShape& shape, bool is_circle, bool is_rectangle, Vec2d half, Vec2d offset);

/// Limits a row's clear semi-diameter to the extent of its aperture's outline.
void limit_to_outline(PrescriptionSurface& row);

/// Returns the corners of a rectangle with the given half-widths that is rotated about the origin.
std::vector<Vec2d> rotated_rectangle(Vec2d half, double angle_deg);

/// True if all values of a non-empty list are equal.
inline bool is_constant(const std::vector<double>& values) {
    return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

/// Returns a glass with these indices. Both lists must have the same length.
Glass glass_of_indices(const std::vector<double>& wavelengths_nm, const std::vector<double>& indices,
                       std::string label);

/// Types of decentre in CODE V and ray-optics: where the placement of a surface is applied.
enum class DecentreKind {
    ordinary,  ///< before the surface: the axis continues from it
    and_return,  ///< before the surface, and reversed after it
    bend,  ///< before the surface, and its tilts again after it, as a mirror folds the axis
    reverse,  ///< only reversed after the surface
};
/// Sets the transforms before and behind a row from its placement.
void set_decentre(const SurfacePlacement& placement, DecentreKind kind, PrescriptionSurface& row);

/// Rotation by three Euler angles, in the convention of SurfacePlacement::tilt_deg.
inline Affine<double> rotation(double x_deg, double y_deg, double z_deg) {
    return SurfacePlacement{{}, {x_deg, y_deg, z_deg}, false}.frame();
}

/// Rotates a toroid by 90 degrees about its axis, so that its section with conic and aspheric terms lies in the xz
/// plane of the lens. The row's frame rotates with it; its transforms and aperture, which must be set before, are
/// adjusted.
void swap_toroid_axes(PrescriptionSurface& row);

}  // namespace realcam::io
