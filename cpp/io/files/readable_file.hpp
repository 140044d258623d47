#pragma once
#include <string>
#include <vector>

namespace realcam::io {

/// Returns why a path cannot be read as a file, to continue a message: "no such file", "is a folder", ...; empty if it
/// can. Pipes and devices are rejected: opening them may block for ever, and reading them may never end.
std::string why_unreadable(const std::string& path);

/// Records the inputs of a command during its lifetime: all files that why_unreadable finds readable. The library does
/// not record any, because its user may well replace a file that was read. At most one object exists at a time.
class InputRecording {
public:
    InputRecording();
    InputRecording(const InputRecording&) = delete;
    InputRecording& operator=(const InputRecording&) = delete;
    ~InputRecording();

    /// Ends the recording: files that are read later, such as earlier outputs, are not inputs.
    void end();
};

std::vector<std::string> recorded_inputs();

}  // namespace realcam::io
