#include "file_beside.hpp"

#include <algorithm>
#include <filesystem>

#include "uri.hpp"

namespace realcam::io {

std::optional<std::string> find_beside(const std::string& scene_path, const std::string& name) {
    namespace fs = std::filesystem;
    // No system has longer paths, and a name with a null character would be truncated at it.
    constexpr std::size_t kLongestPath = 4096;
    if (name.empty() || name.size() > kLongestPath || name.find('\0') != std::string::npos) return std::nullopt;
    const fs::path folder = fs::path(scene_path).parent_path();
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    for (const std::string& spelling : {name, slashes, percent_decoded(slashes)}) {
        if (spelling.find('\0') != std::string::npos) continue;
        for (const fs::path& candidate : {folder / spelling, folder / fs::path(spelling).filename()}) {
            std::error_code error;
            if (fs::is_regular_file(candidate, error)) return candidate.string();
        }
    }
    return std::nullopt;
}

}  // namespace realcam::io
