#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "../../checkpoint.hpp"
#include "../../error.hpp"

namespace realcam::io {

/// Returns the number of bytes that this process may still allocate: the least of the machine's available memory, and
/// the remaining memory of its control groups (containers) and of its address space (`ulimit -v`). UINT64_MAX if none
/// of them is known.
///
/// Linux overcommits: it grants more memory than it has and kills the program when the memory is used. Large
/// allocations are therefore compared with this number first.
std::uint64_t free_memory();

/// Error for a file that cannot be read. The message is "PATH: REASON".
class FileError : public Error {
public:
    FileError(const std::string& path, const std::string& why) : Error(path + ": " + why), reason(why) {}
    std::string reason;  ///< the message without the path
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
    /// Returns the number of bytes that have not been read yet.
    std::uint64_t left() const { return left_; }

    /// Reads the next bytes into `buffer`. Returns their number, which is less than `max_bytes` only at the end of the
    /// file. Throws FileError.
    std::size_t read(char* buffer, std::size_t max_bytes);

private:
    std::string path_;
    int file_ = -1;
    std::uint64_t size_ = 0, left_ = 0;
};

/// Returns the content of a regular file, or its first `max_bytes` bytes. Throws FileError, also if this is more than
/// the free memory.
std::string read_whole_file(const std::string& path, Checkpoint& checkpoint, std::uint64_t max_bytes = UINT64_MAX);

/// Returns the end of an error message such as "1.5 GB, and 0.7 GB of memory are free" if `bytes` exceed the free
/// memory; otherwise empty.
std::string too_much_memory(std::uint64_t bytes);

}  // namespace realcam::io
