#include "lens_text.hpp"

#include <algorithm>
#include <cmath>

#include "../text/printable.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

/// Converts UTF-16 to UTF-8. Throws LensFileError at the line of an invalid character.
std::string from_utf16(std::string_view bytes, bool big_endian, const std::string& file) {
    const auto fail = [&](const std::string& out, const char* what) {
        const auto line = 1 + std::count(out.begin(), out.end(), '\n');
        throw LensFileError(std::string("is UTF-16 text, and ") + what, file, static_cast<int>(line));
    };
    std::string out;
    const auto unit = [&](std::size_t i) {
        const unsigned a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
        return big_endian ? a << 8 | b : b << 8 | a;
    };
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        unsigned point = unit(i);
        if (point >= 0xd800 && point < 0xe000) {
            const unsigned low = i + 3 < bytes.size() ? unit(i + 2) : 0;
            if (point >= 0xdc00 || low < 0xdc00 || low >= 0xe000) fail(out, "has an invalid character");
            point = from_surrogates(point, low);
            i += 2;
        }
        append_utf8(out, point);
    }
    if (bytes.size() % 2) fail(out, "ends in the middle of a character");
    return out;
}

/// Converts Latin-1 to UTF-8.
std::string from_latin1(std::string_view bytes) {
    std::string out;
    for (const char c : bytes) append_utf8(out, static_cast<unsigned char>(c));
    return out;
}

}  // namespace

std::string quoted_list(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + in_quotes(name);
    return text;
}

std::string decoded_lens_text(std::string_view bytes, const std::string& file) {
    using namespace std::string_view_literals;
    std::string text;
    if (bytes.starts_with("\xff\xfe"sv))
        text = from_utf16(bytes.substr(2), false, file);
    else if (bytes.starts_with("\xfe\xff"sv))
        text = from_utf16(bytes.substr(2), true, file);
    else if (bytes.size() > 3 && bytes[0] != 0 && bytes[1] == 0 && bytes[2] != 0 && bytes[3] == 0)
        text = from_utf16(bytes, false, file);  // some programs omit the byte-order mark
    else if (bytes.size() > 3 && bytes[0] == 0 && bytes[1] != 0 && bytes[2] == 0 && bytes[3] != 0)
        text = from_utf16(bytes, true, file);
    else if (bytes.starts_with("\xef\xbb\xbf"sv))
        text = is_utf8(bytes.substr(3)) ? std::string(bytes.substr(3)) : from_latin1(bytes);
    else
        text = is_utf8(bytes) ? std::string(bytes) : from_latin1(bytes);
    if (const std::size_t null = text.find('\0'); null != std::string::npos) {
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(null), '\n');
        throw LensFileError("holds a null character; expected text", file, static_cast<int>(line));
    }
    return text;
}

bool LensLines::next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    const bool is_pair = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (is_pair ? 2 : 1), rest_.size()));
    ++number_;
    checkpoint_.pass(1 + end / 16);
    return true;
}

std::vector<LensWord> LensLines::words(std::string_view line) const {
    std::vector<LensWord> list;
    checkpoint_.pass(1 + line.size() / 16);
    while (true) {
        line = without_blanks(line);
        if (line.empty()) return list;
        const char quote = line[0];
        if (quote == '"' || quote == '\'') {
            const std::size_t end = line.find(quote, 1);
            if (end == line.npos) fail("a text in quotes does not end");
            list.push_back({line.substr(1, end - 1), true});
            line.remove_prefix(end + 1);
        } else {
            const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
            list.push_back({line.substr(0, end)});
            line.remove_prefix(end);
        }
    }
}

double LensLines::number_of(std::string_view word, const std::string& what) const {
    std::string_view rest = word;
    const std::optional<double> value = consume_number(rest);
    if (!value || !rest.empty() || !std::isfinite(*value))
        fail(what + " must be a finite number; it is " + in_quotes(word));
    return *value;
}

int LensLines::whole_number_of(std::string_view word, const std::string& what, int min, int max) const {
    std::string_view rest = word;
    const std::optional<std::int64_t> value = consume_integer(rest);
    if (!value || !rest.empty() || *value < min || *value > max)
        fail(what + " must be a whole number from " + std::to_string(min) + " to " + std::to_string(max) + "; it is " +
             in_quotes(word));
    return static_cast<int>(*value);
}

bool is_digits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
}

bool is_infinity(std::string_view word) {
    if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
    const std::string upper = word.size() < 10 ? upper_case(word) : std::string();
    return upper == "INF" || upper == "INFINITY";
}

std::string short_list(const std::set<std::string>& names) {
    constexpr std::size_t kMaxListed = 12;
    std::string text;
    std::size_t count = 0;
    for (const std::string& name : names) {
        if (count++ == kMaxListed) return text + " and " + std::to_string(names.size() - kMaxListed) + " more";
        text += (text.empty() ? "" : ", ") + name;
    }
    return text;
}

std::string upper_case(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return out;
}

std::string_view without_blanks(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == text.npos) return {};
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

}  // namespace realcam::io
