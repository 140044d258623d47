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

/// Base of the readers of other programs' lens files: the prescription, and the rules that all formats share.
class PrescriptionReader {
protected:
    PrescriptionReader(const char* format, const std::string& file, LensGlasses& glasses);

    [[noreturn]] void fail_at(const std::string& message, int line = 0, int surface = 0) const {
        throw LensFileError(message, p_.file, line, surface);
    }
    /// Records a feature that is not modelled, once for each surface.
    void add_foreign(const std::string& what, int line, int surface);
    /// Adds a remark, once.
    void remark(const std::string& what);

    /// Sets the distance of the object, mm. Distances beyond kLongest are infinite in all programs.
    void set_object(double distance, double curvature, int line);
    /// Sets the wavelengths and the index of the main one.
    void set_wavelengths(std::vector<double> wavelengths_nm, std::size_t main);

    Prescription p_;
    LensGlasses& glasses_;

private:
    std::set<std::pair<std::string, int>> foreign_;
    std::set<std::string> remarks_;
};

/// Command of a text file: its keyword in capitals, and the words behind it. Every error names the line.
class LensCommand {
public:
    LensCommand(const LensLines& lines, std::string word, std::vector<LensWord> values)
        : word(std::move(word)), lines_(lines), values_(std::move(values)) {}

    std::string word;
    std::string what;  ///< the description in the table of keywords

    std::size_t size() const { return values_.size(); }
    const LensWord& operator[](std::size_t i) const { return values_[i]; }
    void remove_first() { values_.erase(values_.begin()); }
    /// Returns a word in capitals, cut to a length; empty if it is absent.
    std::string capital(std::size_t i, std::size_t most = std::string_view::npos) const;

    // Return finite numbers; `name` begins the error message.
    double number(std::size_t i, const std::string& name) const;
    double number_or(std::size_t i, const std::string& name, double otherwise) const;
    double number_or_infinity(std::size_t i, const std::string& name) const;
    std::vector<double> numbers(std::size_t from, const std::string& name) const;
    int whole(std::size_t i, const std::string& name, int least, int most) const;

private:
    const LensLines& lines_;
    std::vector<LensWord> values_;
};

/// Table of a format's keywords, and what they do to the reader. Rows have several keywords, separated by blanks, if
/// these do the same. A row without a function has keywords that are ignored.
template <class Reader>
class Keywords {
public:
    using Function = void (*)(Reader&, LensCommand&);
    struct Row {
        std::string_view words;
        Function read = nullptr;
        std::string_view what = {};  ///< for messages
    };

    Keywords(std::initializer_list<Row> rows) {
        for (const Row& row : rows)
            for (std::size_t at = 0; at < row.words.size();) {
                const std::size_t end = std::min(row.words.find(' ', at), row.words.size());
                rows_.emplace(row.words.substr(at, end - at), row);
                at = end + 1;
            }
    }

    /// Returns the row of a keyword; null if the format does not have it.
    const Row* find(std::string_view word) const {
        const auto found = rows_.find(word);
        return found == rows_.end() ? nullptr : &found->second;
    }

    /// Reads a command. Returns false if the table does not have its keyword.
    bool read(Reader& reader, LensCommand& command) const {
        const Row* row = find(command.word);
        if (row) command.what = row->what;
        if (row && row->read) row->read(reader, command);
        return row;
    }

private:
    std::map<std::string_view, Row> rows_;
};

/// Base of the readers of text files.
class PrescriptionText : protected PrescriptionReader {
public:
    PrescriptionText(const char* format, std::string_view text, const std::string& file, LensGlasses& glasses)
        : PrescriptionReader(format, file, glasses), lines_(text, file, glasses.options().keep_going) {}

protected:
    /// Records a feature that is not modelled, at this line and surface.
    void foreign(const std::string& what) { add_foreign(what, lines_.number(), lines_.surface()); }
    /// Records a command that is not modelled, or left out, as its table describes it.
    void foreign(const LensCommand& command) { foreign(command.what + " (" + command.word + ")"); }
    void left_out(const LensCommand& command) { remark(command.what + " (" + command.word + ")"); }
    /// Records a keyword that is not known.
    void add_unknown(std::string_view word);
    void tell_unknown(const std::string& what);
    /// Returns all values of a command for fields.
    std::vector<double> field_values(const LensCommand& command) const;
    /// Throws LensFileError if a file has so many surfaces that another one is too many.
    void check_count(std::size_t surfaces) const;

    LensLines lines_;

private:
    std::set<std::string> unknown_;
};

/// Returns the length of a unit, "MM" or "INCH", in mm; std::nullopt if it is not known.
std::optional<double> millimetres_of(const std::string& unit);

/// Returns the curvature in 1/mm of a radius in a unit. A radius of 0 means a plane.
inline double curvature_of(double radius, double unit = 1) {
    return radius == 0 ? 0.0 : 1 / (unit * radius);
}

/// Adds a term of the sag, value r^power, in a unit of length given in mm.
void add_term(PrescriptionSurface& row, int power, double value, double unit = 1);

/// Returns the powers of x and y of a term in the order x, y, x^2, x y, y^2, ..., from 1.
std::pair<int, int> xy_powers(int number);

/// Sets the Zernike terms of a row, unless all of them are 0.
void set_zernike(PrescriptionSurface& row, ZernikeOrder order, double radius, std::vector<double> coefficients);

/// Returns a fraction of the pupil that is cut off, below 1.
inline double vignetting(double value) {
    return std::clamp(value, 0.0, 0.999);
}

inline double at_or_0(const std::vector<double>& list, std::size_t i) {
    return i < list.size() ? list[i] : 0.0;
}

/// Sets the outline of an aperture to a circle, a rectangle, or else an ellipse.
void set_outline(ApertureShape& shape, bool is_circle, bool is_rectangle, Vec2d half, Vec2d offset);

/// Limits a row's clear semi-diameter to the extent of its aperture's outline.
void limit_to_outline(PrescriptionSurface& row);

/// Returns the corners of a rectangle that is rotated about the origin.
std::vector<Vec2d> rotated_rectangle(Vec2d half, double angle_deg);

inline bool is_constant(const std::vector<double>& values) {
    return std::ranges::all_of(values, [&](double value) { return value == values.front(); });
}

/// Returns a glass with these indices. Both lists must have the same length.
Glass glass_of_indices(const std::vector<double>& wavelengths_nm, const std::vector<double>& indices,
                       std::string label);

/// Types of decentre in CODE V and ray-optics.
enum class DecentreKind {
    ordinary,    ///< before the surface: the axis continues from it
    and_return,  ///< before the surface, and reversed after it
    bend,        ///< before the surface, and its tilts again after it, as a mirror folds the axis
    reverse,     ///< only reversed after the surface
};
void set_decentre(const SurfacePlacement& placement, DecentreKind kind, PrescriptionSurface& row);

/// Rotation about the fixed axes of a frame.
inline Affine<double> rotation(double x_deg, double y_deg, double z_deg) {
    return SurfacePlacement{{}, {x_deg, y_deg, z_deg}, false}.frame();
}

/// Rotates a toroid about its axis by 90 degrees, so that its section with conic and terms lies in the xz plane. Its
/// placement and its aperture, which must be known, are compensated.
void turn_about_axis(PrescriptionSurface& row);

}  // namespace realcam::io
