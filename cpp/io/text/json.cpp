#include "json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "printable.hpp"
#include "text_number.hpp"

namespace realcam::io {
namespace {

constexpr int kMaxNesting = 200;
constexpr std::size_t kMaxValues = std::size_t{1} << 23;

/// Recursive-descent parser of one document.
class Parser {
public:
    Parser(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers)
        : text_(text), checkpoint_(checkpoint), numbers_(numbers) {}

    Json document() {
        Json value = parse_value(0);
        skip_space();
        if (position_ < text_.size()) fail("the end of the document");
        return value;
    }

private:
    /// Throws std::runtime_error that names the position, what was expected there, and the character that was found.
    [[noreturn]] void fail(const std::string& expected) const {
        const std::string_view before = text_.substr(0, position_);
        const auto line = 1 + std::ranges::count(before, '\n');
        const std::size_t column = position_ - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
        const std::string found =
            position_ < text_.size() ? in_quotes(std::string(text_.substr(position_, 1))) : "the end";
        throw std::runtime_error("line " + std::to_string(line) + ", column " + std::to_string(column) + ": expected " +
                                 expected + ", found " + found);
    }

    void skip_space() { position_ = std::min(text_.find_first_not_of(" \t\r\n", position_), text_.size()); }

    /// Skips white space, and the given word if it follows. Returns false if it does not.
    bool accept(std::string_view word) {
        skip_space();
        if (!text_.substr(position_).starts_with(word)) return false;
        position_ += word.size();
        return true;
    }

    /// Skips the given word, which must follow.
    void expect(std::string_view word) {
        if (!accept(word)) fail("'" + std::string(word) + "'");
    }

    Json parse_value(int depth) {
        if (depth > kMaxNesting) fail("less nesting");
        if (++values_ > kMaxValues) fail("fewer than " + std::to_string(kMaxValues) + " values");
        checkpoint_.pass();
        if (accept("{")) return parse_object(depth);
        if (accept("[")) return parse_array(depth);
        if (accept("\"")) return Json(parse_string());
        if (accept("true")) return Json(true);
        if (accept("false")) return Json(false);
        if (accept("null")) return Json();
        return Json(parse_number());
    }

    double parse_number() {
        if (numbers_ == JsonNumbers::with_infinity) {
            if (accept("Infinity")) return std::numeric_limits<double>::infinity();
            if (accept("-Infinity")) return -std::numeric_limits<double>::infinity();
            if (accept("NaN")) return std::numeric_limits<double>::quiet_NaN();
        }
        std::string_view rest = text_.substr(position_);
        // JSON has neither "+1" nor "nan", which other formats have.
        const std::size_t first = rest.starts_with('-') ? 1 : 0;
        const bool is_number = first < rest.size() && rest[first] >= '0' && rest[first] <= '9';
        const std::optional<double> value = is_number ? consume_number(rest) : std::nullopt;
        if (!value) fail("a value");
        position_ = text_.size() - rest.size();
        return *value;
    }

    Json parse_object(int depth) {
        Json::Object members;
        if (accept("}")) return Json(std::move(members));
        do {
            expect("\"");
            std::string name = parse_string();
            expect(":");
            members.emplace_back(std::move(name), parse_value(depth + 1));
        } while (accept(","));
        expect("}");
        sort_members(members);
        return Json(std::move(members));
    }

    /// Sorts members by name. Of several members of one name, only the last one remains.
    static void sort_members(Json::Object& members) {
        const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
        std::stable_sort(members.begin(), members.end(), before);
        const auto last_of_name = [&](auto from) {
            return std::find_if(from, members.end(), [&](const auto& m) { return m.first != from->first; }) - 1;
        };
        auto unique = members.begin();
        for (auto member = members.begin(); member != members.end(); ++unique) {
            const auto last = last_of_name(member);
            if (unique != last) *unique = std::move(*last);
            member = last + 1;
        }
        members.erase(unique, members.end());
    }

    Json parse_array(int depth) {
        Json::Array elements;
        if (accept("]")) return Json(std::move(elements));
        do {
            elements.push_back(parse_value(depth + 1));
        } while (accept(","));
        expect("]");
        return Json(std::move(elements));
    }

    // Parses a string after its opening quote.
    std::string parse_string() {
        std::string out;
        while (position_ < text_.size() && text_[position_] != '"') {
            if (text_[position_] != '\\') {
                // In chunks, between which the caller may cancel: embedded buffers are strings of megabytes.
                constexpr std::size_t kChunk = 1 << 20;
                const std::size_t last = std::min(position_ + kChunk, text_.size());
                std::size_t end = position_;
                while (end < last && text_[end] != '"' && text_[end] != '\\') ++end;
                out += text_.substr(position_, end - position_);
                checkpoint_.pass((end - position_) / 16);
                position_ = end;
            } else {
                parse_escape(out);
            }
        }
        if (position_ == text_.size()) fail("'\"'");
        ++position_;
        return out;
    }

    /// Parses an escape sequence after its backslash is found, and appends its character.
    void parse_escape(std::string& out) {
        const char code = position_ + 1 < text_.size() ? text_[position_ + 1] : '\0';
        position_ += 2;
        constexpr std::string_view codes = "\"\\/bfnrt", characters = "\"\\/\b\f\n\r\t";
        if (const auto i = codes.find(code); i != std::string_view::npos && code != '\0') {
            out += characters[i];
        } else if (code == 'u') {
            unsigned point = hex4();
            if (point >= 0xd800 && point < 0xdc00 && text_.substr(position_).starts_with("\\u")) {
                position_ += 2;
                const unsigned second = hex4();
                if (second < 0xdc00 || second >= 0xe000) fail("the second half of a surrogate pair after '\\u'");
                point = from_surrogates(point, second);
            }
            append_utf8(out, point);
        } else {
            position_ = std::min(position_, text_.size());
            fail("an escape of JSON after '\\'");
        }
    }

    /// Parses four hexadecimal digits.
    unsigned hex4() {
        unsigned value = 0;
        const std::string_view digits = text_.substr(std::min(position_, text_.size()), 4);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
        if (error != std::errc() || end != digits.data() + 4) fail("four hexadecimal digits after '\\u'");
        position_ += 4;
        return value;
    }

    std::string_view text_;
    Checkpoint& checkpoint_;
    JsonNumbers numbers_;
    std::size_t position_ = 0;  // of the next character
    std::size_t values_ = 0;  // values parsed so far
};

const Json kNull;
const std::string kNoText;

}  // namespace

Json Json::parse(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers) {
    return Parser(text, checkpoint, numbers).document();
}

const Json& Json::operator[](std::string_view name) const {
    const auto* object = std::get_if<Object>(&value_);
    if (!object) return kNull;
    const auto found =
        std::lower_bound(object->begin(), object->end(), name,
                         [](const auto& member, std::string_view expected) { return member.first < expected; });
    return found == object->end() || found->first != name ? kNull : found->second;
}

const Json& Json::operator[](std::size_t i) const {
    const auto* array = std::get_if<Array>(&value_);
    return array && i < array->size() ? (*array)[i] : kNull;
}

std::size_t Json::size() const {
    const auto* array = std::get_if<Array>(&value_);
    return array ? array->size() : 0;
}

double Json::number(double default_value) const {
    const auto* value = std::get_if<double>(&value_);
    return value ? *value : default_value;
}

std::size_t Json::index(std::size_t default_value) const {
    const auto* value = std::get_if<double>(&value_);
    return value && *value >= 0 && *value <= 0x1p53 && *value == std::floor(*value) ? static_cast<std::size_t>(*value)
                                                                                    : default_value;
}

const std::string& Json::text() const {
    const auto* value = std::get_if<std::string>(&value_);
    return value ? *value : kNoText;
}

}  // namespace realcam::io
