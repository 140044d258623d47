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

/// Returns a unique file name in the folder of `path`.
std::string temporary_name(const std::string& path) {
    static std::atomic<int> counter{0};
    const std::string name = ".realcam-" + std::to_string(getpid()) + '-' + std::to_string(counter++) + ".part";
    return (fs::path(folder_of(path)) / name).string();
}

/// Returns the path to which a chain of symbolic links leads; the file need not exist.
std::string resolved_links(std::string path) {
    constexpr int kMaxLinks = 40;  // the kernel's limit
    for (int i = 0; i < kMaxLinks; ++i) {
        std::error_code error;
        const fs::path link = fs::read_symlink(path, error);
        if (error) break;
        path = (link.is_absolute() ? link : fs::path(folder_of(path)) / link).string();
    }
    return path;
}

/// Gives an unnamed file a name. Returns false, and sets errno, if the name exists or the file system does not support
/// it.
bool link_to(std::FILE* file, const std::string& name) {
    const std::string open_file = "/proc/self/fd/" + std::to_string(fileno(file));
    return linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace

UnfinishedFile::UnfinishedFile(const std::string& path) : path_(path), target_(resolved_links(path)) {
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
    // The mode of a replaced file is preserved, because the file may be private. Some file systems do not support
    // modes.
    struct stat replaced{};
    if (stat(target_.c_str(), &replaced) == 0) static_cast<void>(fchmod(descriptor, replaced.st_mode & 07777));
    file_ = fdopen(descriptor, "wb");
    // Unbuffered, because a failed flush in std::fclose would go unnoticed.
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

void check_is_not_an_input(const std::string& output) {
    std::error_code error;
    if (!fs::exists(output, error)) return;
    for (const std::string& input : io::recorded_inputs())
        if (fs::equivalent(output, input, error))
            throw InputError(io::in_quotes(output) + " is also an input of this command (" + io::printable(input) +
                             "); choose another name");
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
    check_is_not_an_input(path_);
}

void UnfinishedFile::fail(int error) const {
    const bool is_full = error == ENOSPC || error == EDQUOT || error == EFBIG;
    throw ImageFileError(
        path_ + ": cannot be written: " +
        (is_full ? "the disk is full, or a limit on file sizes is reached" : std::generic_category().message(error)));
}

void UnfinishedFile::finish() {
    if (failure_ != 0) fail(failure_);
    // Some file systems report only at fsync that they are full.
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
