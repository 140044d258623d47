#include "devices.hpp"

#include <algorithm>
#include <charconv>

#include "../cuda/device/cuda_devices.hpp"
#include "../cuda/session/cuda_gradient.hpp"
#include "../cuda/session/cuda_session.hpp"
#include "../embree/embree_session.hpp"
#include "../embree/lens_rays.hpp"
#include "../embree/picture_gradient.hpp"
#include "../error.hpp"
#include "cuda_plugin.hpp"

namespace realcam {
namespace {

/// Throws InputError for an unknown device name.
[[noreturn]] void fail_unknown(const std::string& device) {
    throw InputError("there is no device \"" + device +
                     "\"; expected auto, cpu, cuda (all GPUs), cuda:0 or cuda:0,1 (`realcam devices` lists them)");
}

/// Parses the ordinals after "cuda:"; empty for "cuda". Throws InputError if they are malformed or repeated.
std::vector<int> ordinals_of(const std::string& device) {
    std::vector<int> ordinals;
    if (device == "cuda") return ordinals;
    const char *at = device.data() + 5, *end = device.data() + device.size();
    for (;; ++at) {
        int ordinal = -1;
        const auto [number_end, error] = std::from_chars(at, end, ordinal);
        const bool is_new = std::find(ordinals.begin(), ordinals.end(), ordinal) == ordinals.end();
        if (error != std::errc() || ordinal < 0 || !is_new || (number_end != end && *number_end != ','))
            fail_unknown(device);
        ordinals.push_back(ordinal);
        at = number_end;
        if (at == end) return ordinals;
    }
}

/// Returns the GPUs of this machine.
std::vector<Device> gpus() {
    std::vector<Device> list;
    for (const CudaDevice& gpu : cuda_devices())
        list.push_back({"cuda:" + std::to_string(gpu.ordinal),
                        gpu.name + " (compute capability " + std::to_string(gpu.major) + "." +
                            std::to_string(gpu.minor) + ", " + std::to_string(gpu.multiprocessors) +
                            " multiprocessors, " + std::to_string(gpu.memory >> 30) + " GiB)"});
    return list;
}

/// Opens a session on these GPUs; empty: all.
std::unique_ptr<Session> make_gpu_session(std::vector<int> ordinals) {
    if (ordinals.empty())
        for (const CudaDevice& gpu : cuda_devices()) ordinals.push_back(gpu.ordinal);
    return make_cuda_session(ordinals, fast_pupil_tracer());
}

/// Returns the ordinal of the single GPU that a device name stands for; "cuda" is the first one. `what_happens`: begins
/// the error message if the name stands for several, as in "frames are taken". Throws InputError and DeviceError.
int single_gpu(const std::string& device, const std::string& what_happens) {
    if (device != "cuda" && !device.starts_with("cuda:")) fail_unknown(device);
    const std::vector<int> ordinals = ordinals_of(device);
    if (ordinals.size() > 1) throw InputError(what_happens + " on a single GPU; use device=\"cuda:0\", for example");
    return cuda_device(ordinals.empty() ? 0 : ordinals.front()).ordinal;
}

/// Opens the first GPU, or the CPU if there is no GPU that this build supports.
std::unique_ptr<Session> make_best_session(const DeviceNotice& notice) {
    std::string why_not;
    try {
        if (!cuda_devices().empty()) return make_gpu_session({0});
        why_not = plugin_failure();
    } catch (const UnsupportedGpu& error) {
        why_not = error.what();
    }
    if (!why_not.empty()) notice("the CPU is used: " + why_not);
    return make_embree_session();
}

}  // namespace

std::vector<Device> devices() {
    std::vector<Device> list = gpus();
    list.insert(list.begin(), {"cpu", make_embree_session()->name()});
    return list;
}

std::unique_ptr<Session> make_session(const std::string& device, const DeviceNotice& notice) {
    if (device == "cpu") return make_embree_session();
    if (device == "auto") return make_best_session(notice);
    if (device == "cuda" || device.starts_with("cuda:")) return make_gpu_session(ordinals_of(device));
    fail_unknown(device);
}

std::unique_ptr<Session> make_live_session(const std::string& device, const DeviceNotice& notice) {
    if (device == "cpu") return make_embree_session();
    if (device == "auto") return make_best_session(notice);
    return make_gpu_session({single_gpu(device, "frames are taken")});
}

std::unique_ptr<CameraGradient> make_gradient(const std::string& device, const Assembly& scene, const Camera& camera,
                                              const RenderSettings& settings, std::vector<LensVariable> variables) {
    const auto on_cpu = [&] {
        return std::make_unique<PictureGradient>(scene, camera, settings, std::move(variables));
    };
    const auto on_gpu = [&](const std::string& name) {
        return make_cuda_gradient(single_gpu(name, "derivatives are computed"), scene, camera, settings, variables,
                                  fast_pupil_tracer());
    };
    if (device == "cpu") return on_cpu();
    if (device != "auto") return on_gpu(device);
    if (!gpu_differentiates(camera.lens) || cuda_devices().empty()) return on_cpu();
    try {
        return on_gpu("cuda");
    } catch (const UnsupportedGpu&) {
        return on_cpu();
    }
}

std::optional<int> gpu_for_rays(const std::string& device) {
    if (device == "cpu" || (device == "auto" && cuda_devices().empty())) return std::nullopt;
    return single_gpu(device == "auto" ? "cuda" : device, "rays are traced");
}

}  // namespace realcam
