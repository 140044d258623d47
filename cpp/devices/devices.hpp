#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace realcam {

class Session;

/// What pictures can be taken with, by the name that make_session takes.
struct Device {
    std::string name;         ///< cpu, cuda:0, cuda:1, ...
    std::string description;  ///< for people
};

/// All devices of this machine, the CPU first.
std::vector<Device> devices();

/// Told a sentence for people: why "auto" is the CPU, where a GPU or the plug-in for GPUs is there but of no use.
using DeviceNotice = std::function<void(const std::string&)>;

/// "auto": the first GPU if there is one that this build has code for, else the CPU. "cpu". "cuda": all GPUs. "cuda:1",
/// "cuda:0,1": those. Throws InputError for another name, and DeviceError where the device is not there or does not
/// work.
std::unique_ptr<Session> make_session(const std::string& device, const DeviceNotice& notice);

/// The same on one device, for frames: "auto" and "cuda" are the first GPU.
std::unique_ptr<Session> make_live_session(const std::string& device, const DeviceNotice& notice);

/// The one GPU that rays alone are traced on, by its ordinal; none for the CPU. "cuda" is the first; for the rest, and
/// for errors, see make_session.
std::optional<int> gpu_for_rays(const std::string& device);

}  // namespace realcam
