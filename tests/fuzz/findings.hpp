#pragma once
// Findings of a fuzz target. Under libFuzzer the first finding ends the process, as its users expect; the driver counts
// findings by kind and continues.

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace realcam::fuzz {

struct Findings {
    struct Kind {
        std::uint64_t count = 0;
        std::uint64_t first_input = 0;
        std::string first;  ///< the numbers of the first case
    };

    std::uint64_t rays = 0;  ///< traced: each number type counts
    std::uint64_t passed = 0;  ///< of these left their lens on the far side
    std::uint64_t files = 0, files_read = 0;
    std::uint64_t pupil_samples = 0, cameras = 0, cameras_made = 0, camera_rays = 0;
    std::uint64_t broken = 0;
    std::uint64_t input = 0;  ///< at work now; the driver counts
    std::map<std::string, Kind> kinds;
};

inline Findings& findings() {
    static Findings all;
    return all;
}

/// `kind`: the broken invariant in a few words; then the numbers of this case, as printf.
__attribute__((format(printf, 2, 3))) inline void report(const char* kind, const char* format, ...) {
    char text[1024];
    std::va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
#if defined(REALCAM_LIBFUZZER)
    std::fprintf(stderr, "%s: %s\n", kind, text);
    std::abort();
#else
    Findings& all = findings();
    ++all.broken;
    Findings::Kind& entry = all.kinds[kind];
    if (entry.count++ == 0) {
        entry.first_input = all.input;
        entry.first = text;
    }
#endif
}

}  // namespace realcam::fuzz
