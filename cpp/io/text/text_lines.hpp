#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "../files/regular_file.hpp"

namespace realcam::io {

/// Reader of the lines of a text file, in chunks: a file of a gigabyte needs little more memory than its longest line.
/// Lines end in \n, \r\n or \r; a backslash at the end continues a line in the next one; a byte-order mark is skipped.
class TextLines {
public:
    /// Opens the file. Throws FileError.
    TextLines(const std::string& path, Checkpoint& checkpoint) : path_(path), checkpoint_(checkpoint), file_(path) {}

    /// Reads the next line, without its end; it is valid until the next call. Returns false at the end of the file.
    /// Throws SceneFileError if the file is not a text: it has a null character, or a line does not end.
    bool next(std::string_view& line);
    /// Returns the number, from 1, of the line that next() returned; of the first one if several were joined.
    std::size_t number() const { return number_; }

private:
    /// Reads the next line without joining continued lines. Returns false at the end of the file.
    bool next_physical(std::string_view& line);
    /// Reads a chunk of the file into the buffer. Returns false at the end of the file.
    bool read_more();
    /// Throws SceneFileError if a line of this length is too long.
    void check_length(std::size_t length) const;

    std::string path_;
    Checkpoint& checkpoint_;
    RegularFile file_;
    std::string buffer_;  ///< chunk of the file
    std::string joined_;  ///< a continued line
    std::size_t begin_ = 0, end_ = 0;  // range of the buffer not yet returned
    std::size_t count_ = 0;  // physical lines read so far
    std::size_t number_ = 0;  // see number()
    bool started_ = false;  // true after the first chunk has been read
    bool after_return_ = false;  // true if the last line ended in \r, which a \n may follow
};

/// Removes the first word of a line, with the blanks around it, and returns the word; empty at the end of the line.
std::string_view consume_word(std::string_view& line);

/// Returns a text without the blanks (spaces, tabs) at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace realcam::io
