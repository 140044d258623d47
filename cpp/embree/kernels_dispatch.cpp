// Chooses among the kernels that were built for several instruction sets.
#include <cstdlib>
#include <string>

#include "../error.hpp"
#include "kernels.hpp"

// REALCAM_INSTRUCTION_SETS lists the instruction sets that were built, the narrowest first: some of SET(v2) SET(v3)
// SET(v4), or SET(native).
#define SET(name) extern "C" const realcam_kernels realcam_kernels_##name;
REALCAM_INSTRUCTION_SETS
#undef SET

namespace realcam {

std::vector<const realcam_kernels*> available_kernels() {
    std::vector<const realcam_kernels*> list;
#if defined(__x86_64__)
#define SET(name) \
    if (__builtin_cpu_supports("x86-64-" #name)) list.push_back(&realcam_kernels_##name);
#else
#define SET(name) list.push_back(&realcam_kernels_##name);
#endif
    REALCAM_INSTRUCTION_SETS
#undef SET
    return list;
}

namespace {

/// Chooses the kernels as kernels() does, each time from scratch.
const realcam_kernels& choose() {
    const auto list = available_kernels();
#define SET(name) " " #name
    const std::string built = REALCAM_INSTRUCTION_SETS;
#undef SET
    if (list.empty())
        throw DeviceError("this realcam is built for x86-64" + built + ", which this processor does not support");
    const char* requested = std::getenv("REALCAM_INSTRUCTION_SET");
    if (!requested) return *list.back();
    std::string names;
    for (const realcam_kernels* kernel : list) {
        if (kernel->instruction_set == std::string(requested)) return *kernel;
        names += (names.empty() ? "" : ", ") + std::string(kernel->instruction_set);
    }
    throw DeviceError("REALCAM_INSTRUCTION_SET is \"" + std::string(requested) + "\"; expected one of " + names);
}

}  // namespace

const realcam_kernels& kernels() {
    static const realcam_kernels& chosen = choose();
    return chosen;
}

}  // namespace realcam
