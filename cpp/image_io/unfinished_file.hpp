#pragma once
#include <cstdio>
#include <string>

namespace realcam::image_io {

/// Output file that appears under its name only when it is complete. Until then it is unnamed, if the file system
/// supports that, so that nothing is left behind even if the program is killed; otherwise it has a temporary name in
/// the same folder.
class UnfinishedFile {
public:
    /// Throws ImageFileError if no file of this name can be created: the folder is not writable, the name is too long,
    /// or it belongs to something other than a file. A symbolic link is followed.
    explicit UnfinishedFile(const std::string& path);
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;
    ~UnfinishedFile();

    /// Returns the stream to write to. It is unbuffered.
    std::FILE* stream() { return file_; }
    /// Records the errno of a failed write, which finish() reports.
    void remember_failure(int error);

    /// Gives the file its name. Throws ImageFileError if this or an earlier write failed.
    void finish();

private:
    /// Throws ImageFileError if the target exists and cannot be replaced, and InputError if it is a recorded input.
    void check_target() const;
    /// Throws ImageFileError for an errno.
    [[noreturn]] void fail(int error) const;

    std::string path_;  ///< path as specified, for messages
    std::string target_;  ///< path after following symbolic links
    std::string temporary_;  ///< temporary name; empty while the file is unnamed
    std::FILE* file_ = nullptr;
    int failure_ = 0;  ///< errno of the first write that failed
};

/// Throws InputError if an output is the same file as an input that was recorded (io::InputRecording).
void check_is_not_an_input(const std::string& output);

}  // namespace realcam::image_io
