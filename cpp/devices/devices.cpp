#include "devices.hpp"

#include <algorithm>
#include <charconv>

#include "../cuda/cuda_backend.hpp"
#include "../cuda/cuda_devices.hpp"
#include "../embree/embree_backend.hpp"
#include "../error.hpp"

namespace realcam {
namespace {

[[noreturn]] void fail_unknown(const std::string& device) {
    throw InputError("there is no device \"" + device +
                     "\"; auto, cpu, cuda (all GPUs), cuda:0 or cuda:0,1 is wanted (`realcam devices` lists them)");
}

/// The numbers after "cuda:"; none for "cuda".
std::vector<int> ordinals_of(const std::string& device) {
    std::vector<int> ordinals;
    if (device == "cuda") return ordinals;
    const char *at = device.data() + 5, *end = device.data() + device.size();
    for (;; ++at) {
        int ordinal = -1;
        const auto [rest, error] = std::from_chars(at, end, ordinal);
        const bool fresh = std::find(ordinals.begin(), ordinals.end(), ordinal) == ordinals.end();
        if (error != std::errc() || ordinal < 0 || !fresh || (rest != end && *rest != ',')) fail_unknown(device);
        ordinals.push_back(ordinal);
        at = rest;
        if (at == end) return ordinals;
    }
}

std::vector<Device> gpus() {
    std::vector<Device> list;
    for (const CudaDevice& gpu : cuda_devices())
        list.push_back({"cuda:" + std::to_string(gpu.ordinal),
                        gpu.name + " (compute capability " + std::to_string(gpu.major) + "." +
                            std::to_string(gpu.minor) + ", " + std::to_string(gpu.multiprocessors) +
                            " multiprocessors, " + std::to_string(gpu.memory >> 30) + " GiB)"});
    return list;
}

std::unique_ptr<Backend> make_gpu_backend(std::vector<int> ordinals) {
    if (ordinals.empty())
        for (const CudaDevice& gpu : cuda_devices()) ordinals.push_back(gpu.ordinal);
    return make_cuda_backend(ordinals, fast_pupil_tracer());
}

/// A GPU that is no use to this build is passed over.
std::unique_ptr<Backend> make_best_backend() {
    try {
        if (!cuda_devices().empty()) return make_gpu_backend({0});
    } catch (const UnsupportedGpu&) {
    }
    return make_embree_backend();
}

}  // namespace

std::vector<Device> devices() {
    std::vector<Device> list = gpus();
    list.insert(list.begin(), {"cpu", make_embree_backend()->name()});
    return list;
}

std::unique_ptr<Backend> make_backend(const std::string& device) {
    if (device == "cpu") return make_embree_backend();
    if (device == "auto") return make_best_backend();
    if (device == "cuda" || device.starts_with("cuda:")) return make_gpu_backend(ordinals_of(device));
    fail_unknown(device);
}

std::optional<int> gpu_for_rays(const std::string& device) {
    if (device == "cpu" || (device == "auto" && cuda_devices().empty())) return std::nullopt;
    if (device != "auto" && device != "cuda" && !device.starts_with("cuda:")) fail_unknown(device);
    const std::vector<int> ordinals = device == "auto" ? std::vector<int>() : ordinals_of(device);
    if (ordinals.size() > 1) throw InputError("rays are traced on one GPU; device=\"cuda:0\", say, is wanted");
    return cuda_device(ordinals.empty() ? 0 : ordinals.front()).ordinal;
}

}  // namespace realcam
