#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "../files/regular_file.hpp"

namespace realcam::io {

/// The lines of a text file, read piece by piece: a file of a gigabyte needs no more memory than its longest line.
/// Lines end in \n, \r\n or \r; one that ends in a backslash goes on in the next; a byte-order mark is left out.
class TextLines {
public:
    /// Throws FileError.
    TextLines(const std::string& path, Checkpoint& checkpoint) : path_(path), checkpoint_(checkpoint), file_(path) {}

    /// The next line, without its end, which lasts until the next call. False at the end of the file. Throws
    /// SceneFileError where the file is no text: it holds a null character, or a line has no end.
    bool next(std::string_view& line);
    /// The number, from 1, of the line that next() gave; of its first line where several are joined.
    std::size_t number() const { return number_; }

private:
    bool next_physical(std::string_view& line);
    bool read_more();
    void check_length(std::size_t length) const;

    std::string path_;
    Checkpoint& checkpoint_;
    RegularFile file_;
    std::string buffer_, joined_;
    std::size_t begin_ = 0, end_ = 0;  // of what is in the buffer and not yet given
    std::size_t count_ = 0, number_ = 0;
    bool started_ = false, after_return_ = false;
};

/// Takes a word from the beginning of a line, and the blanks around it; empty at the line's end.
std::string_view take_word(std::string_view& line);

/// Without blanks at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace realcam::io
