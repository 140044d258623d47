#include "readable_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace realcam::io {

std::string why_unreadable(const std::string& path) {
    const auto reason = [](int error) { return "cannot be read: " + std::generic_category().message(error); };
    if (path.find('\0') != std::string::npos) return "no such file";
    struct stat status{};
    if (stat(path.c_str(), &status) != 0) return errno == ENOENT ? "no such file" : reason(errno);
    if (S_ISDIR(status.st_mode)) return "is a folder, not a file";
    if (!S_ISREG(status.st_mode)) return "is a pipe or a device; an ordinary file is wanted";
    return access(path.c_str(), R_OK) == 0 ? "" : reason(errno);
}

}  // namespace realcam::io
