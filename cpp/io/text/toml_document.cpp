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
constexpr std::size_t kMostLevels = 100;

/// Counts the nesting of brackets and key parts in a text. Invalid TOML is left to the parser: it stops at the first
/// error, up to which this count is right.
class Nesting {
public:
    explicit Nesting(std::string_view text) : text_(text) {}

    /// Returns the line with too many levels, or 0.
    int too_deep() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                skip_string(c);
                continue;
            }
            ++at_;
            switch (c) {
                case '\n': ++line_; [[fallthrough]];
                case ',': key_ = parts_ = 0; break;
                case '#': at_ = std::min(text_.find('\n', at_), text_.size()); break;
                case '.': ++parts_; break;
                case '=': key_ = parts_, parts_ = 0; break;
                case '[':
                case '{': open(); break;
                case ']':
                case '}': close(); break;
                default: break;
            }
            if (around_ + key_ + parts_ > kMostLevels) return line_;
        }
        return 0;
    }

private:
    void open() {
        brackets_.push_back(key_ + parts_ + 1);
        around_ += brackets_.back();
        key_ = parts_ = 0;
    }

    void close() {
        if (brackets_.empty()) return;
        around_ -= brackets_.back();
        brackets_.pop_back();
        key_ = parts_ = 0;
    }

    /// Skips a string. Only basic strings, in double quotes, have escapes.
    void skip_string(char quote) {
        const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
        const bool is_long = text_.substr(at_).starts_with(triple);
        at_ += is_long ? 3 : 1;
        for (; at_ < text_.size(); ++at_) {
            if (text_[at_] == '\n') {
                if (!is_long) return;  // unterminated: invalid TOML
                ++line_;
            } else if (text_[at_] == '\\' && quote == '"') {
                if (at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++line_;
                ++at_;
            } else if (is_long ? text_.substr(at_).starts_with(triple) : text_[at_] == quote) {
                at_ += is_long ? 3 : 1;
                // A long string may have two more quotes at its end.
                while (is_long && at_ < text_.size() && text_[at_] == quote) ++at_;
                return;
            }
        }
    }

    std::string_view text_;
    std::size_t at_ = 0, key_ = 0, parts_ = 0, around_ = 0;
    std::vector<std::size_t> brackets_;
    int line_ = 1;
};

/// Stream buffer that provides a text in pieces, and asks in between whether to go on.
class Pieces : public std::streambuf {
public:
    Pieces(std::string_view text, const KeepGoing& keep_going) : text_(text), checkpoint_(keep_going) {}

private:
    int_type underflow() override {
        if (next_ >= text_.size()) return traits_type::eof();
        piece_ = text_.substr(next_, kPiece);
        next_ += piece_.size();
        checkpoint_.pass(kPiece);
        setg(piece_.data(), piece_.data(), piece_.data() + piece_.size());
        return traits_type::to_int_type(piece_.front());
    }

    // toml++ seeks back to the beginning if there is no byte-order mark.
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override {
        const auto here = static_cast<off_type>(next_) - (egptr() - gptr());
        const off_type base = from == std::ios::beg   ? 0
                              : from == std::ios::cur ? here
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

    static constexpr std::size_t kPiece = 1 << 15;
    std::string_view text_;
    std::size_t next_ = 0;
    std::string piece_;
    Checkpoint checkpoint_;
};

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file, RaiseFileError raise,
                       const KeepGoing& keep_going) {
    if (const int line = Nesting(text).too_deep())
        raise("is nested too deeply; at most " + std::to_string(kMostLevels) +
                  " levels of tables, arrays and parts of a key are read",
              file, line, 0);
    Pieces pieces(text, keep_going);
    std::istream stream(&pieces);
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
