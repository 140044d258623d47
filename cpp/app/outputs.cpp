#include "outputs.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "../error.hpp"
#include "../image_io/image_file.hpp"

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

void check_outputs(const std::vector<std::string>& outputs) {
    for (auto it = outputs.begin(); it != outputs.end(); ++it) {
        image_io::check_image_path(*it);
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

}  // namespace realcam::app
