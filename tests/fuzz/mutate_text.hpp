#pragma once
// Mutations of text that know numbers, words, lines, keys and brackets.

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "bytes.hpp"

namespace realcam::fuzz {

struct Span {
    std::size_t begin, end;
};

inline Span pick(Bytes& in, const std::vector<Span>& spans) {
    return spans[in.word() % spans.size()];
}

/// Spans of characters that a number may consist of, with at least one digit.
inline std::vector<Span> numbers_of(const std::string& text) {
    std::vector<Span> found;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t begin = i;
        while (i < text.size() && std::strchr("0123456789.+-e", text[i]) && text[i]) ++i;
        if (i > begin && text.substr(begin, i - begin).find_first_of("0123456789") != std::string::npos)
            found.push_back({begin, i});
    }
    return found;
}

inline std::vector<Span> lines_of(const std::string& text) {
    std::vector<Span> found;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        found.push_back({begin, end});
        begin = end;
    }
    return found;
}

inline std::string number_or_not(Bytes& in) {
    static constexpr const char* odd[] = {"nan",
                                          "-nan",
                                          "inf",
                                          "-inf",
                                          "0",
                                          "-0.0",
                                          "1e400",
                                          "-1e-400",
                                          "0x10",
                                          "0b1",
                                          "1_000",
                                          "1__0",
                                          "true",
                                          "''",
                                          "\"1\"",
                                          "[]",
                                          "[1]",
                                          "[[1.0, 2.0]]",
                                          "{}",
                                          "1979-05-27",
                                          "9223372036854775807",
                                          "9223372036854775808",
                                          "1e18",
                                          "."};
    if (in.chance(128)) return odd[in.below(static_cast<int>(sizeof odd / sizeof *odd))];
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", in.chance(128) ? in.any() : in.sign() * in.decades(-3, 3));
    return text;
}

/// Spans of words, and of text between quotes.
inline std::vector<Span> words_of(const std::string& text) {
    std::vector<Span> found;
    const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t begin = i;
        while (i < text.size() && in_word(text[i])) ++i;
        if (i > begin) found.push_back({begin, i});
    }
    return found;
}

/// Spans of the bracketed parts of a text, including the brackets.
inline std::vector<Span> brackets_of(const std::string& text) {
    std::vector<Span> found;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '[' || text[i] == '{') open.push_back(i);
        if ((text[i] != ']' && text[i] != '}') || open.empty()) continue;
        found.push_back({open.back(), i + 1});
        open.pop_back();
    }
    return found;
}

/// Applies one of many random changes to a text.
inline void mutate_text(Bytes& in, std::string& text) {
    if (text.empty()) text = "\n";
    switch (in.below(16)) {
        case 0:
        case 1:
        case 2:
        case 3: {
            const std::vector<Span> numbers = numbers_of(text);
            if (numbers.empty()) return;
            const Span at = pick(in, numbers);
            text.replace(at.begin, at.end - at.begin, number_or_not(in));
            return;
        }
        case 4: {
            const Span line = pick(in, lines_of(text));
            text.erase(line.begin, line.end - line.begin);
            return;
        }
        case 5: {
            const std::vector<Span> lines = lines_of(text);
            const Span from = pick(in, lines), to = pick(in, lines);
            text.insert(to.begin, text.substr(from.begin, from.end - from.begin));
            return;
        }
        case 6: {  // a block of lines many times: the same surface, the same table
            const std::vector<Span> lines = lines_of(text);
            const std::size_t first = in.word() % lines.size(),
                              last = std::min(first + static_cast<std::size_t>(in.below(8)), lines.size() - 1);
            const std::string block = text.substr(lines[first].begin, lines[last].end - lines[first].begin);
            for (int i = in.below(256); i > 0 && text.size() < 100000; --i) text.insert(lines[last].end, block);
            return;
        }
        case 7: text[in.word() % text.size()] = static_cast<char>(in.byte()); return;
        case 8: {
            std::string some;
            for (int i = 1 + in.below(16); i > 0; --i) some += static_cast<char>(in.byte());
            text.insert(in.word() % text.size(), some);
            return;
        }
        case 9: text.resize(in.word() % text.size()); return;
        case 10: {  // nesting
            const char open = in.chance(128) ? '[' : '{';
            text.insert(in.word() % text.size(), std::string(static_cast<std::size_t>(in.below(256)) * 40, open));
            return;
        }
        case 11: {  // a word twice, or in another's place
            const std::vector<Span> words = words_of(text);
            if (words.empty()) return;
            const Span from = pick(in, words), to = pick(in, words);
            const std::string word = text.substr(from.begin, from.end - from.begin);
            text.replace(to.begin, in.chance(128) ? 0 : to.end - to.begin, word);
            return;
        }
        case 12: {
            const std::vector<Span> words = words_of(text);
            if (words.empty()) return;
            const Span at = pick(in, words);
            text.erase(at.begin, at.end - at.begin);
            return;
        }
        case 13: {  // a value of JSON with all that is in it, taken away or put elsewhere
            const std::vector<Span> values = brackets_of(text);
            if (values.empty()) return;
            const Span from = pick(in, values), to = pick(in, values);
            const std::string value = text.substr(from.begin, from.end - from.begin);
            if (text.size() < 100000) text.replace(to.begin, to.end - to.begin, in.chance(64) ? "" : value);
            return;
        }
        case 14: {  // one byte many times: a long word, a long line
            const char c = text[in.word() % text.size()];
            text.insert(in.word() % text.size(), std::string(static_cast<std::size_t>(in.below(256)) * 30, c));
            return;
        }
        default: {  // a key in another's place
            const std::vector<Span> lines = lines_of(text);
            const Span from = pick(in, lines), to = pick(in, lines);
            const std::string key = text.substr(from.begin, text.find('=', from.begin) - from.begin);
            const std::size_t equals = text.find('=', to.begin);
            if (key.size() < 40 && equals < to.end) text.replace(to.begin, equals - to.begin, key);
        }
    }
}

/// For messages: the beginning, as one line.
inline std::string start_of(std::string text) {
    for (char& c : text)
        if (c == '\n') c = '|';
    return text.substr(0, 700);
}

}  // namespace realcam::fuzz
