#include "regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "free_memory.hpp"
#include "readable_file.hpp"

namespace realcam::io {
namespace {

std::string reason_of(int error) {
    return "cannot be read: " + std::generic_category().message(error);
}

}  // namespace

RegularFile::RegularFile(const std::string& path) : path_(path) {
    if (const std::string why = why_unreadable(path); !why.empty()) throw FileError(path, why);
    // Opened without blocking, and checked again, in case the file was replaced in between.
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    struct stat status{};
    const bool is_open = file_ >= 0 && fstat(file_, &status) == 0;
    const int error = errno;
    if (is_open && S_ISREG(status.st_mode)) {
        size_ = left_ = static_cast<std::uint64_t>(status.st_size);
        return;
    }
    if (file_ >= 0) close(file_);
    throw FileError(path, is_open ? "is no ordinary file" : reason_of(error));
}

RegularFile::~RegularFile() {
    close(file_);
}

std::size_t RegularFile::read(char* to, std::size_t most) {
    std::size_t done = 0;
    most = static_cast<std::size_t>(std::min<std::uint64_t>(most, left_));
    while (done < most) {
        const ssize_t n = ::read(file_, to + done, most - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw FileError(path_, reason_of(errno));
        if (n == 0) left_ = done;  // the file was truncated
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    left_ -= done;
    return done;
}

std::string read_whole_file(const std::string& path, Checkpoint& checkpoint, std::uint64_t most) {
    RegularFile file(path);
    const std::uint64_t size = std::min(file.size(), most);
    if (const std::string why = too_much_memory(size); !why.empty()) throw FileError(path, "holds " + why);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    constexpr std::size_t kPiece = 1 << 22;
    std::size_t done = 0;
    while (done < bytes.size()) {
        const std::size_t n = file.read(bytes.data() + done, std::min(kPiece, bytes.size() - done));
        if (n == 0) break;
        done += n;
        checkpoint.pass(n / 64);
    }
    bytes.resize(done);
    return bytes;
}

std::string too_much_memory(std::uint64_t bytes) {
    const std::uint64_t free = free_memory();
    if (bytes <= free) return {};
    char text[80];
    std::snprintf(text, sizeof text, "%.1f GB, and %.1f GB of memory are free", static_cast<double>(bytes) / 1e9,
                  static_cast<double>(free) / 1e9);
    return text;
}

}  // namespace realcam::io
