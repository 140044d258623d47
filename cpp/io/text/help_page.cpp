#include "help_page.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <sstream>
#include <string_view>
#include <utility>

namespace realcam::io {
namespace {

constexpr std::size_t kColumns = 80;           // width of the page
constexpr std::size_t kIndent = 2, kGap = 2;  // blanks before a row, and between its columns
/// Greatest width of the column of option names. After longer names, the text begins on the next line.
constexpr std::size_t kMaxNameWidth = 30;

/// Returns the width of a text in columns, one per character of UTF-8.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Appends a text word by word. A word that would exceed the width begins a new line, indented by `indent` blanks.
/// `column`: number of columns already used in the first line.
void append_wrapped(std::string& page, const std::string& text, std::size_t column, std::size_t indent) {
    std::istringstream words(text);
    bool begins_line = true;
    for (std::string word; words >> word; begins_line = false) {
        const std::size_t width = width_of(word);
        if (!begins_line && column + 1 + width > kColumns) {
            page += '\n' + std::string(indent, ' ');
            column = indent;
        } else if (!begins_line) {
            page += ' ';
            ++column;
        }
        page += word;
        column += width;
    }
    page += '\n';
}

/// Appends a section, whose descriptions are aligned in a column.
void append_section(std::string& page, const HelpPage::Section& section) {
    std::size_t max_width = 0;
    for (const auto& [name, text] : section.rows) max_width = std::max(max_width, width_of(name));
    const std::size_t column = kIndent + std::min(max_width, kMaxNameWidth) + kGap;
    page += '\n' + section.title + ":\n";
    for (const auto& [name, text] : section.rows) {
        const std::size_t end = kIndent + width_of(name);
        page += std::string(kIndent, ' ') + name;
        page += end + kGap <= column ? std::string(column - end, ' ') : '\n' + std::string(column, ' ');
        append_wrapped(page, text, column, column);
    }
}

}  // namespace

std::string text_of(const HelpPage& page) {
    std::string text = "Usage: ";
    append_wrapped(text, page.usage, text.size(), text.size());
    for (std::size_t start = 0; start < page.description.size();) {
        const std::size_t end = std::min(page.description.find("\n\n", start), page.description.size());
        text += '\n' + std::string(kIndent, ' ');
        append_wrapped(text, page.description.substr(start, end - start), kIndent, kIndent);
        start = end + 2;
    }
    for (const HelpPage::Section& section : page.sections)
        if (!section.rows.empty()) append_section(text, section);
    if (!page.examples.empty()) text += "\nExamples:\n";
    for (const std::string& example : page.examples) text += std::string(kIndent, ' ') + example + '\n';
    return text;
}

namespace {

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Returns the Levenshtein distance, ignoring case.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t substituted = diagonal + (lower(a[i]) != lower(b[j]));
            diagonal = row[j + 1];
            row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

/// True if the text contains the part, ignoring case.
bool contains(std::string_view text, std::string_view part) {
    return std::search(text.begin(), text.end(), part.begin(), part.end(),
                       [](char x, char y) { return lower(x) == lower(y); }) != text.end();
}

}  // namespace

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
    // Limits, because the work grows with the product of the lengths: longer names are not misspellings, and
    // suggestions from longer lists are not useful.
    constexpr std::size_t kMaxNameLength = 64, kMaxCandidates = 10000;
    if (name.size() > kMaxNameLength || candidates.size() > kMaxCandidates) return {};
    std::vector<std::pair<std::size_t, std::string_view>> closest;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > kMaxNameLength) continue;
        const bool is_part = !name.empty() && (contains(candidate, name) || contains(name, candidate));
        const std::size_t distance = is_part ? 0 : edit_distance(name, candidate);
        // Compares the first word as well ("tesar" for "tessar-50mm"), with a stricter limit because it is short.
        const std::string_view word = std::string_view(candidate).substr(0, candidate.find('-'));
        const std::size_t word_distance = edit_distance(name, word);
        if (distance <= std::max<std::size_t>(2, candidate.size() / 3))
            closest.emplace_back(distance, candidate);
        else if (word_distance <= std::max<std::size_t>(1, word.size() / 3))
            closest.emplace_back(word_distance, candidate);
    }
    std::sort(closest.begin(), closest.end());
    constexpr std::size_t kMaxSuggestions = 3;
    if (closest.size() > kMaxSuggestions) closest.resize(kMaxSuggestions);
    if (closest.empty()) return {};
    std::string text = " (did you mean ";
    for (std::size_t i = 0; i < closest.size(); ++i) {
        if (i > 0) text += i + 1 == closest.size() ? " or " : ", ";
        text += '"' + std::string(closest[i].second) + '"';
    }
    return text + "?)";
}

}  // namespace realcam::io
