#pragma once
#include <OpenImageIO/filesystem.h>

#include <cstdio>
#include <memory>
#include <string>

namespace realcam::image_io {

/// A file under a temporary name in the folder of its final one: it gets that name when it is whole, and goes away
/// otherwise.
class UnfinishedFile {
public:
    /// Throws ImageFileError where the folder takes no file.
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

    [[noreturn]] void fail(int error) const;

    std::string path_, temporary_;
    std::FILE* file_;
    std::unique_ptr<Proxy> proxy_;
};

}  // namespace realcam::image_io
