#include <cstdlib>
#include <string>

#include "../error.hpp"
#include "kernels.hpp"

#if defined(REALCAM_KERNELS_X86)
extern "C" const realcam_kernels realcam_kernels_v2, realcam_kernels_v3, realcam_kernels_v4;
#else
extern "C" const realcam_kernels realcam_kernels_native;
#endif

namespace realcam {

std::vector<const realcam_kernels*> available_kernels() {
    std::vector<const realcam_kernels*> list;
#if defined(REALCAM_KERNELS_X86)
    if (__builtin_cpu_supports("x86-64-v2")) list.push_back(&realcam_kernels_v2);
    if (__builtin_cpu_supports("x86-64-v3")) list.push_back(&realcam_kernels_v3);
    if (__builtin_cpu_supports("x86-64-v4")) list.push_back(&realcam_kernels_v4);
#else
    list.push_back(&realcam_kernels_native);
#endif
    return list;
}

namespace {

const realcam_kernels& choose() {
    const auto list = available_kernels();
    if (list.empty()) throw DeviceError("this processor is older than x86-64-v2 (SSE4.2), which realcam needs");
    const char* asked = std::getenv("REALCAM_INSTRUCTION_SET");
    if (!asked) return *list.back();
    std::string names;
    for (const realcam_kernels* kernel : list) {
        if (kernel->instruction_set == std::string(asked)) return *kernel;
        names += (names.empty() ? "" : ", ") + std::string(kernel->instruction_set);
    }
    throw DeviceError("REALCAM_INSTRUCTION_SET is \"" + std::string(asked) + "\"; this machine has " + names);
}

}  // namespace

const realcam_kernels& kernels() {
    static const realcam_kernels& chosen = choose();
    return chosen;
}

}  // namespace realcam
