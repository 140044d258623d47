#pragma once
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../checkpoint.hpp"
#include "../files/bundled_file.hpp"
#include "lens_error.hpp"

namespace realcam::io {

// Files of lenses/, compiled into the library; the definitions are generated.

// Returns the bundled lenses, in the order of the file names.
std::span<const BundledFile> bundled_lens_files();

// Returns the glass catalogue, lenses/glass.toml; empty if there is no catalogue.
std::string_view bundled_glass_catalogue();

/// Greatest number of surfaces in a file: those of a lens, and as many dummies that are merged.
inline constexpr std::size_t kMostFileSurfaces = 1024;
/// Greatest number of zoom positions, and of field points.
inline constexpr int kMostFileZoomPositions = 1000;
inline constexpr std::size_t kMostFileFields = 1000;
/// Greatest number of points in a table of indices: each surface with the glass has a copy.
inline constexpr std::size_t kMostFileIndices = 10000;

/// Converts another program's text file to UTF-8, from UTF-16 or UTF-8 with or without a byte-order mark, or else from
/// Latin-1. Throws LensFileError if UTF-16 is invalid, or if the text has a null character.
std::string decoded_lens_text(std::string_view bytes, const std::string& file);

/// Word of a line. A text in quotes is one word, without the quotes.
struct LensWord {
    std::string_view text;
    bool is_quoted = false;
};

/// Lines of a lens file, in order; every error names the line. The text has to outlive the object.
class LensLines {
public:
    LensLines(std::string_view text, std::string file, KeepGoing keep_going = {})
        : rest_(text), file_(std::move(file)), checkpoint_(std::move(keep_going)) {}

    /// Reads the next line, without its end; returns false at the end of the text. Throws Cancelled if the caller wants
    /// to stop.
    bool next(std::string_view& line);
    int number() const { return number_; }
    const std::string& file() const { return file_; }

    /// Sets the surface that errors name; 0: no surface.
    void set_surface(int surface) { surface_ = surface; }
    int surface() const { return surface_; }
    [[noreturn]] void fail(const std::string& message) const { throw LensFileError(message, file_, number_, surface_); }
    [[noreturn]] void fail(const InputError& cause) const { throw LensReadError(cause, file_, number_, surface_); }
    /// Splits a line at blanks. Throws LensFileError for a quote that does not end, and Cancelled.
    std::vector<LensWord> words(std::string_view line) const;
    /// Parses a word that is a finite number. `what` begins the error message.
    double number_of(std::string_view word, const std::string& what) const;
    /// Parses a word that is a whole number between two bounds.
    int whole_number_of(std::string_view word, const std::string& what, int least, int most) const;

private:
    std::string_view rest_;
    std::string file_;
    int number_ = 0, surface_ = 0;
    mutable Checkpoint checkpoint_;
};

/// True if a word consists of digits only.
bool is_digits(std::string_view word);

/// True if a word means infinity: "inf", "Infinity", ignoring case, with or without a sign.
bool is_infinity(std::string_view word);

/// Lists names for a sentence, "A, B and 12 more": a file may have thousands.
std::string short_list(const std::set<std::string>& names);

/// Converts to upper case, in which these formats compare their words.
std::string upper_case(std::string_view text);

/// Returns the text without blanks at both ends.
std::string_view without_blanks(std::string_view text);

}  // namespace realcam::io
