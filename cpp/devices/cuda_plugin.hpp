#pragma once
#include <string>

namespace realcam {

struct CudaBackend;

/// Loads the plug-in of a path, which stays loaded. Throws DeviceError where there is none, and where it is of another
/// version or build.
const CudaBackend& load_cuda_plugin(const std::string& path);

/// Where the plug-in is, for a build without the CUDA backend; empty: nowhere. To be said before it is first wanted.
/// The environment's REALCAM_CUDA_PLUGIN goes before.
void name_cuda_plugin(const std::string& path);

/// In one sentence, why the plug-in that is named gives no GPU. Empty where it does, where none is named, and in a
/// build that has the CUDA backend inside.
std::string why_no_gpu_by_plugin();

}  // namespace realcam
