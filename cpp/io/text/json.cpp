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

constexpr int kMostNesting = 200;
constexpr std::size_t kMostValues = std::size_t{1} << 23;

class Parser {
public:
    Parser(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers)
        : text_(text), checkpoint_(checkpoint), numbers_(numbers) {}

    Json document() {
        Json value = parse_value(0);
        skip_space();
        if (at_ < text_.size()) fail("nothing more");
        return value;
    }

private:
    [[noreturn]] void fail(const std::string& wanted) const {
        const std::string_view before = text_.substr(0, at_);
        const auto line = 1 + std::ranges::count(before, '\n');
        const std::size_t column = at_ - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
        const std::string found = at_ < text_.size() ? in_quotes(std::string(text_.substr(at_, 1))) : "the end";
        throw std::runtime_error("line " + std::to_string(line) + ", column " + std::to_string(column) + ": expected " +
                                 wanted + ", found " + found);
    }

    void skip_space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

    bool take(std::string_view word) {
        skip_space();
        if (!text_.substr(at_).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

    void need(std::string_view word) {
        if (!take(word)) fail("'" + std::string(word) + "'");
    }

    Json parse_value(int depth) {
        if (depth > kMostNesting) fail("less nesting");
        if (++values_ > kMostValues) fail("fewer than 8388608 values");
        checkpoint_.pass();
        if (take("{")) return parse_object(depth);
        if (take("[")) return parse_array(depth);
        if (take("\"")) return Json(parse_string());
        if (take("true")) return Json(true);
        if (take("false")) return Json(false);
        if (take("null")) return Json();
        return Json(parse_number());
    }

    double parse_number() {
        if (numbers_ == JsonNumbers::with_infinity) {
            if (take("Infinity")) return std::numeric_limits<double>::infinity();
            if (take("-Infinity")) return -std::numeric_limits<double>::infinity();
            if (take("NaN")) return std::numeric_limits<double>::quiet_NaN();
        }
        std::string_view rest = text_.substr(at_);
        // JSON has neither "+1" nor "nan", which other formats have.
        const std::size_t first = rest.starts_with('-') ? 1 : 0;
        const bool is_number = first < rest.size() && rest[first] >= '0' && rest[first] <= '9';
        const std::optional<double> value = is_number ? take_number(rest) : std::nullopt;
        if (!value) fail("a value");
        at_ = text_.size() - rest.size();
        return *value;
    }

    Json parse_object(int depth) {
        Json::Object members;
        if (take("}")) return Json(std::move(members));
        do {
            need("\"");
            std::string name = parse_string();
            need(":");
            members.emplace_back(std::move(name), parse_value(depth + 1));
        } while (take(","));
        need("}");
        sort_members(members);
        return Json(std::move(members));
    }

    static void sort_members(Json::Object& members) {
        const auto before = [](const auto& a, const auto& b) { return a.first < b.first; };
        std::stable_sort(members.begin(), members.end(), before);
        const auto last_of_name = [&](auto from) {
            return std::find_if(from, members.end(), [&](const auto& m) { return m.first != from->first; }) - 1;
        };
        auto kept = members.begin();
        for (auto member = members.begin(); member != members.end(); ++kept) {
            const auto last = last_of_name(member);
            if (kept != last) *kept = std::move(*last);
            member = last + 1;
        }
        members.erase(kept, members.end());
    }

    Json parse_array(int depth) {
        Json::Array elements;
        if (take("]")) return Json(std::move(elements));
        do {
            elements.push_back(parse_value(depth + 1));
        } while (take(","));
        need("]");
        return Json(std::move(elements));
    }

    // Parses a string after its opening quote.
    std::string parse_string() {
        std::string out;
        while (at_ < text_.size() && text_[at_] != '"') {
            if (text_[at_] != '\\') {
                // In pieces: embedded buffers are strings of megabytes.
                constexpr std::size_t kPiece = 1 << 20;
                const std::size_t last = std::min(at_ + kPiece, text_.size());
                std::size_t end = at_;
                while (end < last && text_[end] != '"' && text_[end] != '\\') ++end;
                out += text_.substr(at_, end - at_);
                checkpoint_.pass((end - at_) / 16);
                at_ = end;
            } else {
                parse_escape(out);
            }
        }
        if (at_ == text_.size()) fail("'\"'");
        ++at_;
        return out;
    }

    void parse_escape(std::string& out) {
        const char code = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
        at_ += 2;
        constexpr std::string_view codes = "\"\\/bfnrt", characters = "\"\\/\b\f\n\r\t";
        if (const auto i = codes.find(code); i != std::string_view::npos && code != '\0') {
            out += characters[i];
        } else if (code == 'u') {
            unsigned point = hex4();
            if (point >= 0xd800 && point < 0xdc00 && text_.substr(at_).starts_with("\\u")) {
                at_ += 2;
                const unsigned second = hex4();
                if (second < 0xdc00 || second >= 0xe000) fail("the second half of a surrogate pair after '\\u'");
                point = from_surrogates(point, second);
            }
            append_utf8(out, point);
        } else {
            at_ = std::min(at_, text_.size());
            fail("an escape of JSON after '\\'");
        }
    }

    unsigned hex4() {
        unsigned value = 0;
        const std::string_view digits = text_.substr(std::min(at_, text_.size()), 4);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
        if (error != std::errc() || end != digits.data() + 4) fail("four hexadecimal digits after '\\u'");
        at_ += 4;
        return value;
    }

    std::string_view text_;
    Checkpoint& checkpoint_;
    JsonNumbers numbers_;
    std::size_t at_ = 0, values_ = 0;
};

const Json none;
const std::string no_text;

}  // namespace

Json Json::parse(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers) {
    return Parser(text, checkpoint, numbers).document();
}

const Json& Json::operator[](std::string_view name) const {
    const auto* object = std::get_if<Object>(&value_);
    if (!object) return none;
    const auto found =
        std::lower_bound(object->begin(), object->end(), name,
                         [](const auto& member, std::string_view wanted) { return member.first < wanted; });
    return found == object->end() || found->first != name ? none : found->second;
}

const Json& Json::operator[](std::size_t i) const {
    const auto* array = std::get_if<Array>(&value_);
    return array && i < array->size() ? (*array)[i] : none;
}

std::size_t Json::size() const {
    const auto* array = std::get_if<Array>(&value_);
    return array ? array->size() : 0;
}

double Json::number(double otherwise) const {
    const auto* value = std::get_if<double>(&value_);
    return value ? *value : otherwise;
}

std::size_t Json::index(std::size_t otherwise) const {
    const auto* value = std::get_if<double>(&value_);
    return value && *value >= 0 && *value <= 0x1p53 && *value == std::floor(*value) ? static_cast<std::size_t>(*value)
                                                                                    : otherwise;
}

const std::string& Json::text() const {
    const auto* value = std::get_if<std::string>(&value_);
    return value ? *value : no_text;
}

}  // namespace realcam::io
