#include "unfinished_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/text/printable.hpp"

namespace realcam::image_io {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& path) {
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

std::string temporary_name(const std::string& path) {
    static std::atomic<int> counter{0};
    const std::string name = ".realcam-" + std::to_string(getpid()) + '-' + std::to_string(counter++) + ".part";
    return (fs::path(folder_of(path)) / name).string();
}

/// Follows symbolic links from a path to a file, which need not exist.
std::string followed(std::string path) {
    constexpr int kMostLinks = 40;  // the kernel's limit
    for (int i = 0; i < kMostLinks; ++i) {
        std::error_code error;
        const fs::path link = fs::read_symlink(path, error);
        if (error) break;
        path = (link.is_absolute() ? link : fs::path(folder_of(path)) / link).string();
    }
    return path;
}

/// Links an unnamed file to a name. Returns false, with errno, if the name exists or the system cannot do it.
bool link_to(std::FILE* file, const std::string& name) {
    const std::string open_file = "/proc/self/fd/" + std::to_string(fileno(file));
    return linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) : path_(path), target_(followed(path)) {
    check_target();
    constexpr mode_t kMode = 0666;
    int descriptor = -1;
#ifdef O_TMPFILE
    descriptor = open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kMode);
#endif
    if (descriptor < 0) {
        temporary_ = temporary_name(target_);
        descriptor = open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, kMode);
        if (descriptor < 0) fail(errno);
    }
    // A replaced file may be private, so its mode is kept. Some file systems do not support modes.
    struct stat before{};
    if (stat(target_.c_str(), &before) == 0) static_cast<void>(fchmod(descriptor, before.st_mode & 07777));
    file_ = fdopen(descriptor, "wb");
    // Unbuffered: whoever closes the picture could otherwise flush a buffer without success, and the error would be
    // lost.
    std::setvbuf(file_, nullptr, _IONBF, 0);
}

UnfinishedFile::~UnfinishedFile() {
    if (!file_) return;
    std::fclose(file_);
    if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void UnfinishedFile::remember_failure(int error) {
    if (failure_ == 0) failure_ = error != 0 ? error : EIO;
}

void check_no_input(const std::string& output) {
    std::error_code error;
    if (!fs::exists(output, error)) return;
    for (const std::string& input : io::recorded_inputs())
        if (fs::equivalent(output, input, error))
            throw InputError(io::in_quotes(output) + " is a file that the output is made from (" +
                             io::printable(input) + "); choose another name");
}

void UnfinishedFile::check_target() const {
    struct stat status{};
    if (stat(target_.c_str(), &status) != 0) {
        if (errno != ENOENT) fail(errno);
        return;
    }
    if (S_ISDIR(status.st_mode)) throw ImageFileError(path_ + ": is a folder; expected the name of a file");
    if (!S_ISREG(status.st_mode)) throw ImageFileError(path_ + ": is a pipe or a device; expected the name of a file");
    if (access(target_.c_str(), W_OK) != 0) fail(errno);
    check_no_input(path_);
}

void UnfinishedFile::fail(int error) const {
    const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    throw ImageFileError(
        path_ + ": cannot be written: " +
        (full ? "the disk is full, or a limit on file sizes is reached" : std::generic_category().message(error)));
}

void UnfinishedFile::finish() {
    if (failure_ != 0) fail(failure_);
    // Some file systems report only now that they are full.
    if (fsync(fileno(file_)) != 0) fail(errno);
    // linkat does not replace an existing name, but rename does.
    if (temporary_.empty() && !link_to(file_, target_)) {
        const std::string name = temporary_name(target_);
        if (!link_to(file_, name)) fail(errno);
        temporary_ = name;
    }
    if (!temporary_.empty() && std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    temporary_.clear();
    std::fclose(file_);
    file_ = nullptr;
}

}  // namespace realcam::image_io
