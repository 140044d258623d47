#pragma once
// The fuzz targets: functions of bytes that report() their findings.

#include <cstddef>
#include <cstdint>

#include "findings.hpp"

namespace realcam::fuzz {

int fuzz_lens_trace(const std::uint8_t* data, std::size_t size);
int fuzz_lens_file(const std::uint8_t* data, std::size_t size);
int fuzz_camera(const std::uint8_t* data, std::size_t size);

// Targets of the program realcam_fuzz_files.
int fuzz_obj(const std::uint8_t* data, std::size_t size);
int fuzz_mtl(const std::uint8_t* data, std::size_t size);
int fuzz_gltf(const std::uint8_t* data, std::size_t size);
int fuzz_glb(const std::uint8_t* data, std::size_t size);
int fuzz_compressed(const std::uint8_t* data, std::size_t size);
int fuzz_ply(const std::uint8_t* data, std::size_t size);
int fuzz_scene_file(const std::uint8_t* data, std::size_t size);
int fuzz_shot_file(const std::uint8_t* data, std::size_t size);
int fuzz_picture(const std::uint8_t* data, std::size_t size);

using Target = int (*)(const std::uint8_t* data, std::size_t size);

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
