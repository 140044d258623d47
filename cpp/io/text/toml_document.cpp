// Compiles toml++'s parser, once for the library.
#define TOML_IMPLEMENTATION
#include "toml_document.hpp"

#include <algorithm>
#include <cstdlib>
#include <istream>
#include <streambuf>
#include <vector>

#include "../../checkpoint.hpp"
#include "printable.hpp"

namespace realcam::io {
namespace {

/// Greatest number of nested tables and arrays. toml++ parses, copies and frees levels recursively, so that the stack
/// limits them; it limits brackets itself, but not the parts of a key ("a.b.c" is three tables).
constexpr std::size_t kMaxLevels = 100;

/// Counts the nesting of brackets and key parts in a text. Invalid TOML is left to the parser, which stops at the first
/// error; the count is correct up to it.
class Nesting {
public:
    explicit Nesting(std::string_view text) : text_(text) {}

    /// Returns the first line with more than kMaxLevels levels; 0 if there is none.
    int line_of_excess() {
        while (position_ < text_.size()) {
            const char c = text_[position_];
            if (c == '"' || c == '\'') {
                skip_string(c);
                continue;
            }
            ++position_;
            switch (c) {
                case '\n': ++line_; [[fallthrough]];
                case ',': key_levels_ = dots_ = 0; break;
                case '#': position_ = std::min(text_.find('\n', position_), text_.size()); break;
                case '.': ++dots_; break;
                case '=': key_levels_ = dots_, dots_ = 0; break;
                case '[':
                case '{': open(); break;
                case ']':
                case '}': close(); break;
                default: break;
            }
            if (enclosing_levels_ + key_levels_ + dots_ > kMaxLevels) return line_;
        }
        return 0;
    }

private:
    /// An opening bracket: the current key and its bracket become enclosing levels.
    void open() {
        brackets_.push_back(key_levels_ + dots_ + 1);
        enclosing_levels_ += brackets_.back();
        key_levels_ = dots_ = 0;
    }

    void close() {
        if (brackets_.empty()) return;
        enclosing_levels_ -= brackets_.back();
        brackets_.pop_back();
        key_levels_ = dots_ = 0;
    }

    /// Skips a string. Only basic strings, in double quotes, have escapes.
    void skip_string(char quote) {
        const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
        const bool is_long = text_.substr(position_).starts_with(triple);
        position_ += is_long ? 3 : 1;
        for (; position_ < text_.size(); ++position_) {
            if (text_[position_] == '\n') {
                if (!is_long) return;  // unterminated: invalid TOML
                ++line_;
            } else if (text_[position_] == '\\' && quote == '"') {
                if (position_ + 1 < text_.size() && text_[position_ + 1] == '\n') ++line_;
                ++position_;
            } else if (is_long ? text_.substr(position_).starts_with(triple) : text_[position_] == quote) {
                position_ += is_long ? 3 : 1;
                // A long string may have two more quotes at its end.
                while (is_long && position_ < text_.size() && text_[position_] == quote) ++position_;
                return;
            }
        }
    }

    std::string_view text_;
    std::size_t position_ = 0;
    std::size_t key_levels_ = 0;  ///< dots in the key before the current value
    std::size_t dots_ = 0;  ///< dots since the last separator
    std::size_t enclosing_levels_ = 0;  ///< levels of all open brackets and their keys
    std::vector<std::size_t> brackets_;  ///< levels that each open bracket has added
    int line_ = 1;
};

/// Stream buffer over a text that the parser reads in chunks, between which `keep_going` may cancel.
class ChunkedStream : public std::streambuf {
public:
    ChunkedStream(std::string_view text, const KeepGoing& keep_going) : text_(text), checkpoint_(keep_going) {}

private:
    int_type underflow() override {
        if (next_ >= text_.size()) return traits_type::eof();
        chunk_ = text_.substr(next_, kChunk);
        next_ += chunk_.size();
        checkpoint_.pass(kChunk);
        setg(chunk_.data(), chunk_.data(), chunk_.data() + chunk_.size());
        return traits_type::to_int_type(chunk_.front());
    }

    // toml++ seeks back to the beginning if there is no byte-order mark.
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override {
        const auto position = static_cast<off_type>(next_) - (egptr() - gptr());
        const off_type base = from == std::ios::beg   ? 0
                              : from == std::ios::cur ? position
                                                      : static_cast<off_type>(text_.size());
        return seekpos(base + offset, which);
    }
    pos_type seekpos(pos_type position, std::ios::openmode) override {
        const off_type offset = position;
        if (offset < 0 || offset > static_cast<off_type>(text_.size())) return off_type(-1);
        next_ = static_cast<std::size_t>(offset);
        setg(nullptr, nullptr, nullptr);
        return position;
    }

    static constexpr std::size_t kChunk = 1 << 15;
    std::string_view text_;
    std::size_t next_ = 0;
    std::string chunk_;
    Checkpoint checkpoint_;
};

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file, RaiseFileError raise,
                       const KeepGoing& keep_going) {
    if (const int line = Nesting(text).line_of_excess())
        raise("is nested too deeply; at most " + std::to_string(kMaxLevels) +
                  " levels of tables, arrays and parts of a key are read",
              file, line, 0);
    ChunkedStream chunks(text, keep_going);
    std::istream stream(&chunks);
    stream.exceptions(std::ios::badbit);  // passes on exceptions from keep_going
    try {
        return toml::parse(stream, file);
    } catch (const toml::parse_error& error) {
        raise("not valid TOML: " + printable(error.description()), file, static_cast<int>(error.source().begin.line),
              0);
    }
    std::abort();  // raise has thrown
}

}  // namespace realcam::io
