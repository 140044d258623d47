#pragma once
// Functions of Open Image Denoise's C interface (version 2), with the types and names of its documentation. The library
// is loaded when a picture is to be denoised, so that nothing else depends on it.

#include <cstddef>
#include <string>

namespace realcam::oidn {

using Device = struct OIDNDeviceImpl*;
using Buffer = struct OIDNBufferImpl*;
using Filter = struct OIDNFilterImpl*;
using Stream = struct CUstream_st*;
using Monitor = bool (*)(void* user, double done);

// Values of the interface's enumerations.
inline constexpr int kCpu = 1, kFloat3 = 3, kCancelled = 6, kFast = 4, kBalanced = 5, kHigh = 6;

/// The functions of the library: oidnNewDevice and so on.
struct Library {
    Device (*new_device)(int type);
    Device (*new_cuda_device)(const int* ordinals, const Stream* streams, int count);
    bool (*is_cuda_device_supported)(int ordinal);
    void (*set_device_int)(Device, const char* name, int value);
    void (*set_device_bool)(Device, const char* name, bool value);
    int (*get_device_int)(Device, const char* name);
    void (*commit_device)(Device);
    void (*release_device)(Device);
    int (*get_device_error)(Device, const char** message);
    Buffer (*new_buffer)(Device, std::size_t bytes);
    void (*write_buffer)(Buffer, std::size_t offset, std::size_t bytes, const void* from);
    void (*read_buffer)(Buffer, std::size_t offset, std::size_t bytes, void* to);
    void (*release_buffer)(Buffer);
    Filter (*new_filter)(Device, const char* type);
    void (*set_filter_image)(Filter, const char* name, Buffer, int format, std::size_t width, std::size_t height,
                             std::size_t offset, std::size_t pixel_stride, std::size_t row_stride);
    void (*set_filter_bool)(Filter, const char* name, bool value);
    void (*set_filter_int)(Filter, const char* name, int value);
    void (*set_filter_monitor)(Filter, Monitor, void* user);
    void (*commit_filter)(Filter);
    void (*execute_filter)(Filter);
    void (*release_filter)(Filter);
};

/// Returns the library at a path; if empty, the one that the environment variable REALCAM_OIDN names, or else the
/// system's. It stays loaded. Throws InputError, which says what to install, if it cannot be loaded.
const Library& library(const std::string& path);

}  // namespace realcam::oidn
