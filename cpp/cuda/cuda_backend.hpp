#pragma once
#include "../bvh/scene_bvh.hpp"
#include "device/cuda_devices.hpp"
#include "device/shared_device_array.hpp"
#include "rays/bench_kernels.hpp"
#include "rays/cuda_rays.hpp"
#include "rays/ray_arrays.hpp"
#include "session/cuda_gradient.hpp"
#include "session/cuda_session.hpp"

namespace realcam {

/// Functions of the CUDA backend, for builds in which it is a plug-in (a library of its own). C++ objects and
/// exceptions of the core cross the border of the library, so that both sides must be compiled from the same headers,
/// which cuda_backend_stamp verifies. Each member is the function of the same name.
struct CudaBackend {
    decltype(&realcam::cuda_devices) cuda_devices;
    decltype(&realcam::why_no_cuda_device) why_no_cuda_device;
    decltype(&realcam::cuda_device) cuda_device;
    decltype(&realcam::make_cuda_session) make_cuda_session;
    decltype(&realcam::make_cuda_gradient) make_cuda_gradient;
    decltype(&realcam::trace_rays_on_gpu) trace_rays_on_gpu;
    decltype(&realcam::trace_arrays) trace_arrays;
    decltype(&realcam::generate_ray_arrays) generate_ray_arrays;
    decltype(&realcam::gpu_of_address) gpu_of_address;
    decltype(&realcam::wait_for_gpu) wait_for_gpu;
    void (*download)(const SharedDeviceArray& array, void* to);
    SharedDeviceArray (*duplicate)(const SharedDeviceArray& array);
    decltype(&realcam::lens_ray_rates) lens_ray_rates;
    decltype(&realcam::hit_rates) hit_rates;
};

/// Functions of realcam that the plug-in calls, because they need Embree and TBB.
struct CudaHost {
    decltype(&realcam::build_scene_bvh) build_scene_bvh;
    decltype(&realcam::refit_instances) refit_instances;
    decltype(&realcam::bvh_instances) bvh_instances;
};

/// Returns the version of realcam and a hash of all headers. Defined by cmake/RealcamCudaStamp.cmake.
const char* cuda_backend_stamp();

/// The two exported functions of the plug-in and their symbol names. The second is called only if the stamps are equal;
/// `host` must outlive the plug-in.
using CudaPluginStamp = const char*();
using CudaPluginBackend = const CudaBackend*(const CudaHost* host);
inline constexpr const char* kCudaPluginStamp = "realcam_cuda_stamp";
inline constexpr const char* kCudaPluginBackend = "realcam_cuda_backend";

}  // namespace realcam
