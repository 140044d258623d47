#pragma once
#include <string>

namespace realcam {

struct CudaBackend;

/// Loads the library with the CUDA backend (cpp/cuda_plugin) at a path, and returns its functions; it stays loaded.
/// Throws DeviceError if it cannot be loaded, or is of another version or build.
const CudaBackend& load_cuda_plugin(const std::string& path);

/// Sets the path of the plug-in, for a build without the CUDA backend; empty: no plug-in. Must be called before the
/// plug-in is first used. The environment variable REALCAM_CUDA_PLUGIN takes precedence.
void set_cuda_plugin_path(const std::string& path);

/// Returns a message that says why the plug-in provides no GPU. Empty if it provides one, if no path is set, and in a
/// build with the CUDA backend.
std::string plugin_failure();

}  // namespace realcam
