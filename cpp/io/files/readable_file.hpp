#pragma once
#include <string>
#include <vector>

namespace realcam::io {

/// Returns the reason why a path cannot be read as a file, for the end of a message: "no such file", "is a folder",
/// ...; empty if it can be read. Pipes and devices are rejected, because opening them may block for ever, and reading
/// them may never end.
std::string why_unreadable(const std::string& path);

/// Records the inputs of a command during its lifetime: all files that why_unreadable finds readable. Only
/// commands record their inputs: a user of the library may well replace a file that was read. At most one object exists
/// at a time.
class InputRecording {
public:
    InputRecording();
    InputRecording(const InputRecording&) = delete;
    InputRecording& operator=(const InputRecording&) = delete;
    ~InputRecording();

    /// Ends the recording: files that are read later, such as earlier outputs, are not inputs.
    void end();
};

/// Returns the paths recorded so far; empty without a recording.
std::vector<std::string> recorded_inputs();

}  // namespace realcam::io
