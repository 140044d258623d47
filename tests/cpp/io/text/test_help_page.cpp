#include <sstream>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "io/text/help_page.hpp"

using realcam::io::HelpPage;
using realcam::io::text_of;

TEST_CASE("a page of help has its parts in order") {
    const HelpPage page{"realcam x [OPTIONS] FILE",
                        "Does x.\n\nAnd more.",
                        {{"Arguments", {{"FILE", "A file"}}}, {"Nothing", {}}, {"Options", {{"-h, --help", "Help"}}}},
                        {"realcam x a.txt"}};
    CHECK(text_of(page) ==
          "Usage: realcam x [OPTIONS] FILE\n\n  Does x.\n\n  And more.\n\nArguments:\n  FILE  A file\n\n"
          "Options:\n  -h, --help  Help\n\nExamples:\n  realcam x a.txt\n");
}

TEST_CASE("no line of help is wider than 80 columns, and none ends before it has to") {
    std::string words;
    for (int i = 0; i < 100; ++i) words += (i % 3 ? "word " : "m² ");
    const HelpPage page{words, words, {{"Options", {{"--option", words}, {std::string(60, 'o'), words}}}}, {}};
    std::istringstream text(text_of(page));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::size_t columns = 0;
        for (const char c : lines[i]) columns += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
        INFO(lines[i]);
        CHECK(columns <= 80);
        CHECK(lines[i].find_last_not_of(' ') + 1 == lines[i].size());
        // If the text continues in the next line, the longest word and the space before it would not fit any more.
        const bool goes_on = i + 1 < lines.size() && lines[i + 1].starts_with("       ");
        if (goes_on && lines[i].find("word") != std::string::npos) CHECK(columns > 75);
    }
}

TEST_CASE("text beside a long name begins in the next line, in the column of all others") {
    const HelpPage page{
        "x", "x", {{"Options", {{std::string(31, 'o'), "first"}, {std::string(30, 'o'), "second"}}}}, {}};
    CHECK(text_of(page).find(std::string(31, 'o') + '\n' + std::string(34, ' ') + "first\n") != std::string::npos);
    CHECK(text_of(page).find("  " + std::string(30, 'o') + "  second\n") != std::string::npos);
}
