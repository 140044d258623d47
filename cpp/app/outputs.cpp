#include "outputs.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <regex>
#include <system_error>

#include "../error.hpp"
#include "../image_io/image_file.hpp"
#include "../io/files/file_suffix.hpp"

namespace realcam::app {
namespace {

namespace fs = std::filesystem;

/// Whether both names mean the same file, also where neither exists yet.
bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error) && !error;
}

}  // namespace

bool is_film(const std::string& output) {
    return io::suffix_of(output) == ".mp4";
}

void check_outputs(const std::vector<std::string>& outputs) {
    for (auto it = outputs.begin(); it != outputs.end(); ++it) {
        if (!is_film(*it)) image_io::check_image_path(*it);
        if (std::any_of(outputs.begin(), it, [&](const std::string& other) { return same_file(other, *it); }))
            throw InputError("--output: \"" + *it + "\" is given twice");
    }
}

void check_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    for (const std::string& output : outputs)
        for (const std::string& input : inputs)
            if (!input.empty() && same_file(output, input))
                throw InputError("--output: \"" + output + "\" is a file that the picture is made from (" + input +
                                 "); another name is wanted");
}

std::vector<int> frame_numbers(const std::string& text) {
    static const std::regex kRange(R"((\d{1,6})(?:-(\d{1,6})(?:x(\d{1,6}))?)?)");
    std::smatch found;
    std::vector<int> numbers;
    if (std::regex_match(text, found, kRange)) {
        const auto number = [&](std::size_t i, int without) {
            return found[i].matched ? std::stoi(found[i]) : without;
        };
        const int first = number(1, 0), last = number(2, first), step = number(3, 1);
        for (int n = first; n <= last && step > 0; n += step) numbers.push_back(n);
    }
    if (numbers.empty())
        throw InputError("--frames: \"" + text.substr(0, 40) +
                         "\": a number, 1-240 or 1-240x2 is wanted, the smaller one first");
    return numbers;
}

std::string frame_file(const std::string& output, int number) {
    const std::filesystem::path path(output);
    const std::string name = path.filename().string();
    const std::size_t end = name.find_last_of('#');
    const std::size_t begin = end == name.npos ? end : name.find_last_not_of('#', end) + 1;  // npos + 1 is 0
    char digits[24];
    std::snprintf(digits, sizeof digits, "%0*d",
                  end == name.npos ? 4 : static_cast<int>(std::min<std::size_t>(end + 1 - begin, 20)), number);
    const std::string numbered = end == name.npos ? path.stem().string() + '.' + digits + path.extension().string()
                                                  : name.substr(0, begin) + digits + name.substr(end + 1);
    return (path.parent_path() / numbered).string();
}

}  // namespace realcam::app
