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

/// Returns the bundled lens files, sorted by file name.
std::span<const BundledFile> bundled_lens_files();

/// Returns the text of the bundled glass catalogue, lenses/glass.toml; empty if there is none.
std::string_view bundled_glass_catalogue();

/// Greatest number of surfaces in a file: those of a lens, and as many dummy surfaces, which are merged.
inline constexpr std::size_t kMaxFileSurfaces = 1024;
/// Greatest numbers of zoom positions and of field points in a file.
inline constexpr int kMaxFileZoomPositions = 1000;
inline constexpr std::size_t kMaxFileFields = 1000;
/// Greatest number of points in a table of indices: each surface with the glass holds a copy.
inline constexpr std::size_t kMaxFileIndices = 10000;

/// Converts another program's text file to UTF-8, from UTF-16 or UTF-8 with or without a byte-order mark, or else from
/// Latin-1. Throws LensFileError if UTF-16 is invalid, or if the text has a null character.
std::string decoded_lens_text(std::string_view bytes, const std::string& file);

/// Returns names in quotation marks, with commas between them.
std::string quoted_list(const std::vector<std::string>& names);

/// Word of a line. A text in quotes is one word, without the quotes.
struct LensWord {
    std::string_view text;
    bool is_quoted = false;
};

/// Reads a lens file line by line, and parses the words of lines. Every error names the current line and surface. The
/// text must outlive the object.
class LensLines {
public:
    LensLines(std::string_view text, std::string file, KeepGoing keep_going = {})
        : rest_(text), file_(std::move(file)), checkpoint_(std::move(keep_going)) {}

    /// Reads the next line, without its end; returns false at the end of the text. Throws Cancelled if
    /// `keep_going` returns false.
    bool next(std::string_view& line);
    /// Number of the current line, from 1; 0 before the first.
    int number() const { return number_; }
    const std::string& file() const { return file_; }

    /// Sets the surface that errors name; 0: no surface.
    void set_surface(int surface) { surface_ = surface; }
    int surface() const { return surface_; }
    [[noreturn]] void fail(const std::string& message) const { throw LensFileError(message, file_, number_, surface_); }
    [[noreturn]] void fail(const InputError& cause) const { throw LensReadError(cause, file_, number_, surface_); }
    /// Splits a line at blanks into words. Throws LensFileError for a quote that does not end, and Cancelled.
    std::vector<LensWord> words(std::string_view line) const;
    /// Parses a word as a finite number. `what`: noun phrase for the number, which begins the error message.
    double number_of(std::string_view word, const std::string& what) const;
    /// Parses a word as a whole number from `min` to `max`.
    int whole_number_of(std::string_view word, const std::string& what, int min, int max) const;

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

/// Lists the first 12 names for a sentence: "A, B and 70 more".
std::string short_list(const std::set<std::string>& names);

/// Converts ASCII letters to upper case, in which keywords are compared.
std::string upper_case(std::string_view text);

/// Returns the text without blanks at both ends.
std::string_view without_blanks(std::string_view text);

}  // namespace realcam::io
