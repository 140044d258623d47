#include "unfinished_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "../error.hpp"

namespace realcam::image_io {
namespace {

std::string temporary_name(const std::string& path) {
    static std::atomic<int> counter{0};
    const std::string name = ".realcam-" + std::to_string(getpid()) + '-' + std::to_string(counter++) + ".part";
    return (std::filesystem::path(path).parent_path() / name).string();
}

}  // namespace

class UnfinishedFile::Proxy final : public OIIO::Filesystem::IOFile {
public:
    explicit Proxy(std::FILE* file) : IOFile(file, Write) {}

    std::size_t write(const void* data, std::size_t size) override {
        errno = 0;
        const std::size_t written = IOFile::write(data, size);
        if (written != size && error == 0) error = errno != 0 ? errno : EIO;
        // Encoders that notice print lines of their own, or let it pass; finish() tells it in both cases.
        return size;
    }

    int error = 0;
};

UnfinishedFile::UnfinishedFile(const std::string& path)
    : path_(path), temporary_(temporary_name(path)), file_(std::fopen(temporary_.c_str(), "wbx")) {
    if (!file_) fail(errno);
    // A buffer could be emptied, in vain, by whoever closes the picture, and the error be lost.
    std::setvbuf(file_, nullptr, _IONBF, 0);
    proxy_ = std::make_unique<Proxy>(file_);
}

UnfinishedFile::~UnfinishedFile() {
    proxy_.reset();
    if (!file_) return;
    std::fclose(file_);
    std::remove(temporary_.c_str());
}

OIIO::Filesystem::IOProxy& UnfinishedFile::proxy() {
    return *proxy_;
}

void UnfinishedFile::fail(int error) const {
    const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    throw ImageFileError(
        path_ + ": cannot be written: " +
        (full ? "the disk is full, or a limit on file sizes is reached" : std::generic_category().message(error)));
}

void UnfinishedFile::finish() {
    if (proxy_->error != 0) fail(proxy_->error);
    // Some file systems find out only now that they are full.
    if (fsync(fileno(file_)) != 0) fail(errno);
    proxy_.reset();
    const bool closed = std::fclose(file_) == 0;
    const int close_error = errno;
    file_ = nullptr;
    if (closed && std::rename(temporary_.c_str(), path_.c_str()) == 0) return;
    const int error = closed ? errno : close_error;
    std::remove(temporary_.c_str());
    fail(error);
}

}  // namespace realcam::image_io
