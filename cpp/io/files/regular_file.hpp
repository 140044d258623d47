#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "../../checkpoint.hpp"
#include "../../error.hpp"

namespace realcam::io {

/// Returns the number of bytes that this process may still allocate: the machine's available memory, limited by what
/// its container or control group and its address space (`ulimit -v`) leave. The largest number if the system does not
/// say.
///
/// Linux hands out more memory than there is and kills the program when it is used; therefore the program asks before
/// it allocates a large picture.
std::uint64_t free_memory();

/// Error for a file that cannot be read. The message is "PATH: REASON".
class FileError : public Error {
public:
    FileError(const std::string& path, const std::string& why) : Error(path + ": " + why), reason(why) {}
    std::string reason;
};

/// File on a disk, open for reading. Pipes and devices, which may have no end or block their reader, are rejected
/// before they are opened.
class RegularFile {
public:
    /// Opens the file. Throws FileError if it cannot be read.
    explicit RegularFile(const std::string& path);
    RegularFile(const RegularFile&) = delete;
    RegularFile& operator=(const RegularFile&) = delete;
    ~RegularFile();

    /// Returns the size of the file when it was opened. Data that are appended later are not read.
    std::uint64_t size() const { return size_; }
    std::uint64_t left() const { return left_; }

    /// Reads the next bytes, fewer than `most` only at the end, and returns how many. Throws FileError.
    std::size_t read(char* to, std::size_t most);

private:
    std::string path_;
    int file_ = -1;
    std::uint64_t size_ = 0, left_ = 0;
};

/// Returns the content of a regular file, or its first `most` bytes. Throws FileError, also if this is more than the
/// free memory.
std::string read_whole_file(const std::string& path, Checkpoint& checkpoint, std::uint64_t most = UINT64_MAX);

/// Returns an error text such as "1.5 GB, and 0.7 GB of memory are free", to end a message with; empty if the memory is
/// free.
std::string too_much_memory(std::uint64_t bytes);

}  // namespace realcam::io
