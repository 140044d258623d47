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
namespace {

const realcam_kernels& choose() {
#if defined(REALCAM_KERNELS_X86)
    const char* asked = std::getenv("REALCAM_INSTRUCTION_SET");
    const std::string limit = asked ? asked : "v4";
    if (limit != "v2" && limit != "v3" && limit != "v4")
        throw DeviceError("REALCAM_INSTRUCTION_SET is \"" + limit + "\"; v2, v3 or v4 is wanted");
    if (limit >= "v4" && __builtin_cpu_supports("x86-64-v4")) return realcam_kernels_v4;
    if (limit >= "v3" && __builtin_cpu_supports("x86-64-v3")) return realcam_kernels_v3;
    if (__builtin_cpu_supports("x86-64-v2")) return realcam_kernels_v2;
    throw DeviceError("this processor is older than x86-64-v2 (SSE4.2), which realcam needs");
#else
    return realcam_kernels_native;
#endif
}

}  // namespace

const realcam_kernels& kernels() {
    static const realcam_kernels& chosen = choose();
    return chosen;
}

}  // namespace realcam
