#include "regular_file.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>

#include "readable_file.hpp"

namespace realcam::io {
namespace {

/// Message for an errno.
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
    throw FileError(path, is_open ? "is not an ordinary file" : reason_of(error));
}

RegularFile::~RegularFile() {
    close(file_);
}

std::size_t RegularFile::read(char* buffer, std::size_t max_bytes) {
    std::size_t done = 0;
    max_bytes = static_cast<std::size_t>(std::min<std::uint64_t>(max_bytes, left_));
    while (done < max_bytes) {
        const ssize_t n = ::read(file_, buffer + done, max_bytes - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw FileError(path_, reason_of(errno));
        if (n == 0) left_ = done;  // the file was truncated
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    left_ -= done;
    return done;
}

std::string read_whole_file(const std::string& path, Checkpoint& checkpoint, std::uint64_t max_bytes) {
    RegularFile file(path);
    const std::uint64_t size = std::min(file.size(), max_bytes);
    if (const std::string why = too_much_memory(size); !why.empty()) throw FileError(path, "holds " + why);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    constexpr std::size_t kChunk = 1 << 22;
    std::size_t done = 0;
    while (done < bytes.size()) {
        const std::size_t n = file.read(bytes.data() + done, std::min(kChunk, bytes.size() - done));
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

namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// Reads a file that contains one number, or a word such as "max", for which it returns kUnknown.
std::uint64_t number_in_file(const std::string& path) {
    std::uint64_t value = 0;
    return std::ifstream(path) >> value ? value : kUnknown;
}

/// Returns the machine's available memory; kUnknown if the system does not report it.
std::uint64_t available_on_machine() {
    std::ifstream file("/proc/meminfo");
    for (std::string name; file >> name;) {
        std::uint64_t kibibytes = 0;
        if (name == "MemAvailable:" && file >> kibibytes) return 1024 * kibibytes;
        file.ignore(1000, '\n');
    }
    return kUnknown;
}

/// Returns the least memory limit of this process's control group and of the groups above it. Inside a container the
/// groups' paths often do not exist, and the container's own limit lies at the root.
std::uint64_t control_group_limit() {
    std::uint64_t limit = kUnknown;
    std::ifstream file("/proc/self/cgroup");
    for (std::string line; std::getline(file, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controller = line.substr(first + 1, second - first - 1);
        const bool unified = controller.empty();
        if (!unified && controller != "memory") continue;
        const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        const std::string name = unified ? "/memory.max" : "/memory.limit_in_bytes";
        for (std::string group = line.substr(second + 1);; group.erase(group.rfind('/'))) {
            limit = std::min(limit, number_in_file(root + group + name));
            if (group.find('/') == std::string::npos) break;
        }
    }
    return limit;
}

/// Memory in use by this process, in bytes (or in pages): its address space, and the resident part of it.
struct MemoryUse {
    std::uint64_t addresses = 0, memory = 0;
};

MemoryUse memory_use() {
    MemoryUse pages;
    std::ifstream("/proc/self/statm") >> pages.addresses >> pages.memory;
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return {page * pages.addresses, page * pages.memory};
}

/// Returns the limit of the address space, as set by `ulimit -v`; kUnknown if it is unlimited.
std::uint64_t address_space_limit() {
    rlimit limit{};
    return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? limit.rlim_cur : kUnknown;
}

std::uint64_t remaining(std::uint64_t limit, std::uint64_t used) {
    return limit == kUnknown ? kUnknown : limit - std::min(limit, used);
}

}  // namespace

std::uint64_t free_memory() {
    const MemoryUse used = memory_use();
    return std::min({available_on_machine(), remaining(control_group_limit(), used.memory),
                     remaining(address_space_limit(), used.addresses)});
}

}  // namespace realcam::io
