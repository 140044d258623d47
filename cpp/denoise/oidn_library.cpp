#include "oidn_library.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <map>
#include <mutex>

#include "../error.hpp"

namespace realcam::oidn {
namespace {

/// Name by which the dynamic loader finds an installed library.
constexpr const char* kSystemLibrary = "libOpenImageDenoise.so.2";

/// Throws InputError with the reason why the library cannot be used.
[[noreturn]] void fail(const std::string& why) {
    throw InputError(
        "Open Image Denoise is not installed (" + why +
        "); install it with pip install realcam[denoise], or set REALCAM_OIDN to the path of libOpenImageDenoise.so");
}

/// Returns the last error of the dynamic loader.
std::string last_error() {
    const char* error = dlerror();
    return error ? error : "no reason is given";
}

/// Sets `function` to the function of this name. Throws InputError if it is missing.
template <class F>
void find(void* handle, const char* name, F*& function) {
    function = reinterpret_cast<F*>(dlsym(handle, name));
    if (!function) fail(last_error());
}

/// Loads the library at a path. Throws InputError.
Library loaded(const std::string& path) {
    void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle) fail(last_error());
    Library l;
    find(handle, "oidnNewDevice", l.new_device);
    find(handle, "oidnNewCUDADevice", l.new_cuda_device);
    find(handle, "oidnIsCUDADeviceSupported", l.is_cuda_device_supported);
    find(handle, "oidnSetDeviceInt", l.set_device_int);
    find(handle, "oidnSetDeviceBool", l.set_device_bool);
    find(handle, "oidnGetDeviceInt", l.get_device_int);
    find(handle, "oidnCommitDevice", l.commit_device);
    find(handle, "oidnReleaseDevice", l.release_device);
    find(handle, "oidnGetDeviceError", l.get_device_error);
    find(handle, "oidnNewBuffer", l.new_buffer);
    find(handle, "oidnWriteBuffer", l.write_buffer);
    find(handle, "oidnReadBuffer", l.read_buffer);
    find(handle, "oidnReleaseBuffer", l.release_buffer);
    find(handle, "oidnNewFilter", l.new_filter);
    find(handle, "oidnSetFilterImage", l.set_filter_image);
    find(handle, "oidnSetFilterBool", l.set_filter_bool);
    find(handle, "oidnSetFilterInt", l.set_filter_int);
    find(handle, "oidnSetFilterProgressMonitorFunction", l.set_filter_monitor);
    find(handle, "oidnCommitFilter", l.commit_filter);
    find(handle, "oidnExecuteFilter", l.execute_filter);
    find(handle, "oidnReleaseFilter", l.release_filter);
    return l;
}

/// Returns `path` or, if it is empty, the value of REALCAM_OIDN or the name of the system's library.
std::string path_or_default(const std::string& path) {
    if (!path.empty()) return path;
    const char* named = std::getenv("REALCAM_OIDN");
    return named && *named ? named : kSystemLibrary;
}

}  // namespace

const Library& library(const std::string& path) {
    static std::mutex mutex;
    static auto* const libraries = new std::map<std::string, Library>;  // never freed: their threads may outlive main
    const std::string path_or_name = path_or_default(path);
    const std::lock_guard lock(mutex);
    const auto known = libraries->find(path_or_name);
    return known != libraries->end() ? known->second
                                     : libraries->emplace(path_or_name, loaded(path_or_name)).first->second;
}

}  // namespace realcam::oidn
