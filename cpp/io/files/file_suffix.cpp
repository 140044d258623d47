#include "file_suffix.hpp"

#include <filesystem>

namespace realcam::io {

std::string suffix_of(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix;
}

}  // namespace realcam::io
