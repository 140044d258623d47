#pragma once
#include <string>

namespace realcam {

struct CudaBackend;

/// Loads the plug-in at a path; it stays loaded. Throws DeviceError if it cannot be loaded, or is of another version or
/// build.
const CudaBackend& load_cuda_plugin(const std::string& path);

/// Sets the path of the plug-in, for a build without the CUDA backend; empty: no plug-in. To be called before the
/// plug-in is first used. The environment variable REALCAM_CUDA_PLUGIN takes precedence.
void name_cuda_plugin(const std::string& path);

/// Returns one sentence that says why the named plug-in provides no GPU. Empty if it provides one, if no plug-in is
/// named, and in a build with the CUDA backend.
std::string why_no_gpu_by_plugin();

}  // namespace realcam
