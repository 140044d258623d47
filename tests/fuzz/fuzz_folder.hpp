#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace realcam::fuzz {

/// A folder of this process for the files that a target reads; gone when the process ends as it should, so that a
/// crash leaves the file that brought it about.
class FuzzFolder {
public:
    static const FuzzFolder& get() {
        static const FuzzFolder folder;
        return folder;
    }

    std::string write(const std::string& name, const std::string& content) const {
        std::string path = (path_ / name).string();
        std::ofstream(path, std::ios::binary) << content;
        return path;
    }
    std::string path(const std::string& name) const { return (path_ / name).string(); }

    FuzzFolder(const FuzzFolder&) = delete;
    FuzzFolder& operator=(const FuzzFolder&) = delete;
    ~FuzzFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

private:
    FuzzFolder() : path_(std::filesystem::temp_directory_path() / ("realcam-fuzz-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(path_);
    }
    std::filesystem::path path_;
};

}  // namespace realcam::fuzz
