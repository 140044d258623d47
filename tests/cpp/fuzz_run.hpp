#pragma once
#include <cstdio>
#include <string>

#include "../fuzz/inputs.hpp"
#include "measurement.hpp"

// The fuzz targets of tests/fuzz for a few seconds, always with the same inputs; `./run fuzz` goes on for hours.

namespace realcam::test {

inline std::string count_of(std::uint64_t n) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", static_cast<double>(n));
    return text;
}

/// Runs a target until the counter `counts` reaches `wanted`. Returns the number of broken invariants.
inline double run_target(fuzz::Target target, std::uint64_t fuzz::Findings::* counts, std::uint64_t wanted) {
    fuzz::Findings& all = fuzz::findings();
    all = {};
    const fuzz::Run run = fuzz::run_inputs(target, 1, [&] { return all.*counts >= wanted; }, [](const fuzz::Input&) {});
    CHECK(run.slowest < 20);  // of processor time: the usual input takes milliseconds
    for (const auto& [kind, found] : all.kinds)
        MESSAGE(kind << ", " << found.count << " times, first in input " << found.first_input << ": " << found.first);
    return static_cast<double>(all.broken);
}

/// Mutates files of one kind: each must be read as a valid value, or refused with an error.
inline void hold_mutated_files(const char* kind, fuzz::Target target) {
    const double broken = run_target(target, &fuzz::Findings::files, 150);
    CHECK(fuzz::findings().files_read > 5);  // the checks must get past the refusals
    hold({"Scenes", std::string("mutated files that end in anything but what they should be or an error: ") + kind,
          std::to_string(fuzz::findings().files) + " files", "core", "float64", broken, 0, "files"});
}

}  // namespace realcam::test
