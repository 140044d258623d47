#pragma once
#include <cstdio>
#include <string>

namespace realcam::image_io {

/// A file that gets its name when it is whole. Until then it has none where the file system can do that, so that
/// nothing is left behind even by a program that is killed, and a temporary one in the same folder elsewhere.
class UnfinishedFile {
public:
    /// Throws ImageFileError where no file of this name can be made: the folder takes none, the name is too long, or it
    /// belongs to something else than a file. A symbolic link is followed.
    explicit UnfinishedFile(const std::string& path);
    UnfinishedFile(const UnfinishedFile&) = delete;
    UnfinishedFile& operator=(const UnfinishedFile&) = delete;
    ~UnfinishedFile();

    /// Where it is written to. It has no buffer.
    std::FILE* stream() { return file_; }
    /// A write failed with this errno: finish() will tell.
    void remember_failure(int error);

    /// Gives the file its name. Throws ImageFileError where the system refused that, or a write before.
    void finish();

private:
    void check_target() const;
    [[noreturn]] void fail(int error) const;

    std::string path_;  ///< as the user calls it
    std::string target_;  ///< what it is a link to, or itself
    std::string temporary_;  ///< empty where the file has no name yet
    std::FILE* file_ = nullptr;
    int failure_ = 0;  ///< errno of the first write that failed
};

/// Throws InputError if an output is the same file as an input that was recorded (io::InputRecording).
void check_no_input(const std::string& output);

}  // namespace realcam::image_io
