#pragma once
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../checkpoint.hpp"
#include "lens_error.hpp"

namespace realcam::io {

/// Surfaces that a file may have before it is refused: those of a lens, and as many dummies that are merged away.
inline constexpr std::size_t kMostFileSurfaces = 1024;
/// The same for zoom positions, and for field points.
inline constexpr int kMostFileZoomPositions = 1000;
inline constexpr std::size_t kMostFileFields = 1000;
/// Points of a table of indices: each surface that has the glass has a copy.
inline constexpr std::size_t kMostFileIndices = 10000;

/// The bytes of another program's text file as UTF-8: UTF-16 with or without its byte-order mark, UTF-8 with or
/// without, else Latin-1. Throws LensFileError where UTF-16 is broken, or the text holds a null character.
std::string decoded_lens_text(std::string_view bytes, const std::string& file);

/// One word of a line. Quotes join words, and are left out.
struct LensWord {
    std::string_view text;
    bool is_quoted = false;
};

/// The lines of a lens file, one after the other; every complaint names the line. It lives no longer than the text.
class LensLines {
public:
    LensLines(std::string_view text, std::string file, KeepGoing keep_going = {})
        : rest_(text), file_(std::move(file)), checkpoint_(std::move(keep_going)) {}

    /// The next line without its end; false at the end of the text. Throws Cancelled where the caller wants to stop.
    bool next(std::string_view& line);
    int number() const { return number_; }
    const std::string& file() const { return file_; }

    /// The surface that complaints name; 0: none.
    void set_surface(int surface) { surface_ = surface; }
    [[noreturn]] void fail(const std::string& message) const { throw LensFileError(message, file_, number_, surface_); }
    [[noreturn]] void fail(const InputError& cause) const { throw LensReadError(cause, file_, number_, surface_); }
    /// The words between blanks. Throws LensFileError for a quote that does not end, and Cancelled.
    std::vector<LensWord> words(std::string_view line) const;
    /// A finite number, as a whole word. `what` begins the message.
    double number_of(std::string_view word, const std::string& what) const;
    /// A whole number between two bounds.
    int whole_number_of(std::string_view word, const std::string& what, int least, int most) const;

private:
    std::string_view rest_;
    std::string file_;
    int number_ = 0, surface_ = 0;
    mutable Checkpoint checkpoint_;
};

/// Whether a word means infinity: "inf", "Infinity", in any case, with a sign or without.
bool is_infinity(std::string_view word);

/// Names in a sentence, "A, B and 12 more": a file may have thousands.
std::string short_list(const std::set<std::string>& names);

/// In capital letters, as these formats compare their words.
std::string upper_case(std::string_view text);

/// Without blanks at both ends.
std::string_view without_blanks(std::string_view text);

}  // namespace realcam::io
