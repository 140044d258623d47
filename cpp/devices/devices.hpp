#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace realcam {

class CameraGradient;
class Session;
struct Assembly;
struct Camera;
struct LensVariable;
struct RenderSettings;

/// Device to render on.
struct Device {
    std::string name;         ///< name for make_session: cpu, cuda:0, cuda:1, ...
    std::string description;  ///< for display
};

/// Returns all devices of this machine, the CPU first.
std::vector<Device> devices();

/// Receives a sentence for the user: why "auto" chooses the CPU although a GPU or the plug-in for GPUs is present.
using DeviceNotice = std::function<void(const std::string&)>;

/// Opens a session on a device. "auto": the first GPU if this build has code for it, else the CPU. "cpu": the CPU.
/// "cuda": all GPUs. "cuda:1" or "cuda:0,1": these GPUs. Throws InputError for another name, and DeviceError if the
/// device is missing or does not work.
std::unique_ptr<Session> make_session(const std::string& device, const DeviceNotice& notice);

/// Opens a session on a single device, for live frames: "cuda" is the first GPU, and several GPUs are an InputError.
/// Otherwise as make_session.
std::unique_ptr<Session> make_live_session(const std::string& device, const DeviceNotice& notice);

/// Prepares the derivatives of a picture on a single device: "cuda" is the first GPU, and several GPUs are an
/// InputError. "auto": the first GPU if there is one that this build supports and it supports the lens, else the CPU.
/// See make_session for other names and for errors, and CameraGradient for the other parameters.
std::unique_ptr<CameraGradient> make_gradient(const std::string& device, const Assembly& scene, const Camera& camera,
                                              const RenderSettings& settings, std::vector<LensVariable> variables);

/// Returns the ordinal of the GPU on which a device name lets arrays of rays be traced, or std::nullopt for the CPU.
/// "cuda" is the first GPU, and several GPUs are an InputError; see make_session for other names and for errors.
std::optional<int> gpu_for_rays(const std::string& device);

}  // namespace realcam
