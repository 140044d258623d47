#pragma once
#include <OpenImageIO/filesystem.h>

#include <cstdio>
#include <memory>
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

    /// Where OpenImageIO writes to.
    OIIO::Filesystem::IOProxy& proxy();

    /// Gives the file its name. Throws ImageFileError where the system refused that, or a write before.
    void finish();

private:
    class Proxy;

    void check_target() const;
    [[noreturn]] void fail(int error) const;

    std::string path_;  ///< as the user calls it
    std::string target_;  ///< what it is a link to, or itself
    std::string temporary_;  ///< empty where the file has no name yet
    std::FILE* file_ = nullptr;
    std::unique_ptr<Proxy> proxy_;
};

}  // namespace realcam::image_io
