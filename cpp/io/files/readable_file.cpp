#include "readable_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <mutex>
#include <set>
#include <system_error>

namespace realcam::io {
namespace {

/// Files recorded by InputRecording.
struct Inputs {
    std::mutex mutex;
    bool is_recording = false;
    std::set<std::string> paths;
};

Inputs& inputs() {
    static Inputs inputs;
    return inputs;
}

}  // namespace

InputRecording::InputRecording() {
    const std::lock_guard lock(inputs().mutex);
    inputs().is_recording = true;
}

InputRecording::~InputRecording() {
    const std::lock_guard lock(inputs().mutex);
    inputs().is_recording = false;
    inputs().paths.clear();
}

void InputRecording::end() {
    const std::lock_guard lock(inputs().mutex);
    inputs().is_recording = false;
}

std::vector<std::string> recorded_inputs() {
    const std::lock_guard lock(inputs().mutex);
    return {inputs().paths.begin(), inputs().paths.end()};
}

std::string why_unreadable(const std::string& path) {
    const auto reason = [](int error) { return "cannot be read: " + std::generic_category().message(error); };
    if (path.find('\0') != std::string::npos) return "no such file";
    struct stat status{};
    if (stat(path.c_str(), &status) != 0) return errno == ENOENT ? "no such file" : reason(errno);
    if (S_ISDIR(status.st_mode)) return "is a folder, not a file";
    if (!S_ISREG(status.st_mode)) return "is a pipe or a device; expected an ordinary file";
    if (access(path.c_str(), R_OK) != 0) return reason(errno);
    const std::lock_guard lock(inputs().mutex);
    if (inputs().is_recording) inputs().paths.insert(path);
    return "";
}

}  // namespace realcam::io
