#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "../../checkpoint.hpp"
#include "../../error.hpp"

namespace realcam::io {

/// A file that cannot be read. The message is "PATH: REASON".
class FileError : public Error {
public:
    FileError(const std::string& path, const std::string& why) : Error(path + ": " + why), reason(why) {}
    std::string reason;
};

/// A file on a disk, open for reading. Pipes and devices, which may have no end or keep their reader waiting, are
/// refused before they are opened.
class RegularFile {
public:
    /// Throws FileError.
    explicit RegularFile(const std::string& path);
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    ~RegularFile();

    /// Bytes that were in it when it was opened. What is written to it later is not read.
    std::uint64_t size() const { return size_; }
    std::uint64_t left() const { return left_; }

    /// The next bytes, fewer than `most` only at the end; how many. Throws FileError.
    std::size_t read(char* to, std::size_t most);

private:
    std::string path_;
    int file_ = -1;
    std::uint64_t size_ = 0, left_ = 0;
};

/// All of a regular file, or its first `most` bytes. Throws FileError, also where these are more than the memory that
/// is free.
std::string read_whole_file(const std::string& path, Checkpoint& checkpoint, std::uint64_t most = UINT64_MAX);

/// "1.5 GB, and 0.7 GB of memory are free": the second half of a message that refuses. Empty where it is free.
std::string too_much_memory(std::uint64_t bytes);

}  // namespace realcam::io
