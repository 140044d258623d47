#include "free_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace realcam::io {
namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// Reads a file that contains one number, or a word such as "max", for which it returns kUnknown.
std::uint64_t number_in(const std::string& path) {
    std::uint64_t value = 0;
    return std::ifstream(path) >> value ? value : kUnknown;
}

std::uint64_t available_on_machine() {
    std::ifstream file("/proc/meminfo");
    for (std::string name; file >> name;) {
        std::uint64_t kibibytes = 0;
        if (name == "MemAvailable:" && file >> kibibytes) return 1024 * kibibytes;
        file.ignore(1000, '\n');
    }
    return kUnknown;
}

/// Returns the least limit of this process's control group and of the groups above it. Inside a container the groups'
/// paths often do not exist, and the container's own limit lies at the root.
std::uint64_t limit_of_groups() {
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
            limit = std::min(limit, number_in(root + group + name));
            if (group.find('/') == std::string::npos) break;
        }
    }
    return limit;
}

/// Memory in use by this process: its address space, and the resident part of it.
struct Taken {
    std::uint64_t addresses = 0, memory = 0;
};

Taken taken_by_process() {
    Taken pages;
    std::ifstream("/proc/self/statm") >> pages.addresses >> pages.memory;
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return {page * pages.addresses, page * pages.memory};
}

/// Returns the limit of the address space, as set by `ulimit -v`.
std::uint64_t limit_of_addresses() {
    rlimit limit{};
    return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? limit.rlim_cur : kUnknown;
}

std::uint64_t left_of(std::uint64_t limit, std::uint64_t taken) {
    return limit == kUnknown ? kUnknown : limit - std::min(limit, taken);
}

}  // namespace

std::uint64_t free_memory() {
    const Taken taken = taken_by_process();
    return std::min({available_on_machine(), left_of(limit_of_groups(), taken.memory),
                     left_of(limit_of_addresses(), taken.addresses)});
}

}  // namespace realcam::io
