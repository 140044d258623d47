#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../error.hpp"

namespace realcam::io {

/// Surfaces that a file may have before it is refused: those of a lens, and as many dummies that are merged away.
inline constexpr std::size_t kMostFileSurfaces = 1024;

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
    LensLines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {}

    /// The next line without its end; false at the end of the text.
    bool next(std::string_view& line);
    int number() const { return number_; }
    const std::string& file() const { return file_; }

    /// The surface that complaints name; 0: none.
    void set_surface(int surface) { surface_ = surface; }
    [[noreturn]] void fail(const std::string& message) const { throw LensFileError(message, file_, number_, surface_); }
    /// The words between blanks. Throws LensFileError for a quote that does not end.
    std::vector<LensWord> words(std::string_view line) const;
    /// A finite number, as a whole word. `what` begins the message.
    double number_of(std::string_view word, const std::string& what) const;
    /// A whole number between two bounds.
    int whole_number_of(std::string_view word, const std::string& what, int least, int most) const;

private:
    std::string_view rest_;
    std::string file_;
    int number_ = 0, surface_ = 0;
};

/// In capital letters, as these formats compare their words.
std::string upper_case(std::string_view text);

/// Without blanks at both ends.
std::string_view without_blanks(std::string_view text);

}  // namespace realcam::io
