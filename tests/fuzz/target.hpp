#pragma once
// The fuzz targets: functions of bytes, that report() what they find.

#include <cstddef>
#include <cstdint>

#include "findings.hpp"

namespace realcam::fuzz {

int fuzz_lens_trace(const std::uint8_t* data, std::size_t size);
int fuzz_lens_file(const std::uint8_t* data, std::size_t size);
int fuzz_camera(const std::uint8_t* data, std::size_t size);

}  // namespace realcam::fuzz

/// libFuzzer takes one target for each program.
#if defined(REALCAM_LIBFUZZER)
#define REALCAM_FUZZ_TARGET(target)                                                     \
    extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
        return realcam::fuzz::target(data, size);                                       \
    }
#else
#define REALCAM_FUZZ_TARGET(target)
#endif
