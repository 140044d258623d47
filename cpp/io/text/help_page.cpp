#include "help_page.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace realcam::io {
namespace {

constexpr std::size_t kColumns = 80, kIndent = 2, kGap = 2;
/// Greatest width of the column of option names. After longer names, the text begins on the next line.
constexpr std::size_t kWidestName = 30;

/// Returns the width in columns, where continuation bytes of UTF-8 count 0.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// Appends words, and begins a line, indented by `indent` blanks, before a word that would exceed the width. `column`:
/// start of the text.
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

void append_section(std::string& page, const HelpPage::Section& section) {
    std::size_t widest = 0;
    for (const auto& [name, text] : section.rows) widest = std::max(widest, width_of(name));
    const std::size_t column = kIndent + std::min(widest, kWidestName) + kGap;
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

}  // namespace realcam::io
