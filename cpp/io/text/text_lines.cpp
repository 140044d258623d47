#include "text_lines.hpp"

#include <algorithm>
#include <cstring>

namespace realcam::io {
namespace {

constexpr std::size_t kPiece = 1 << 20;
/// Allows a polygon of tens of millions of corners, but not a file without lines.
constexpr std::size_t kLongestLine = std::size_t{1} << 28;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

}  // namespace

bool TextLines::read_more() {
    if (begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_;
        begin_ = 0;
    }
    if (buffer_.size() - end_ < kPiece) buffer_.resize(std::max(2 * buffer_.size(), kPiece + end_));
    const std::size_t n = file_.read(buffer_.data() + end_, kPiece);
    checkpoint_.pass(n / 64);
    end_ += n;
    return n > 0;
}

void TextLines::check_length(std::size_t length) const {
    if (length <= kLongestLine) return;
    throw SceneFileError(path_ + ": line " + std::to_string(count_ + 1) + ": is longer than 268435456 bytes");
}

bool TextLines::next_physical(std::string_view& line) {
    if (!started_) {
        started_ = true;
        read_more();
        if (std::string_view(buffer_.data(), end_).starts_with(kByteOrderMark)) begin_ = kByteOrderMark.size();
    }
    std::size_t searched = 0;
    while (true) {
        if (after_return_ && begin_ < end_) {
            if (buffer_[begin_] == '\n') ++begin_;
            after_return_ = false;
        }
        std::size_t at = begin_ + searched;
        // The characters that end a line, and the null character, are at most '\r'.
        while (at < end_ && (static_cast<unsigned char>(buffer_[at]) > '\r' ||
                             (buffer_[at] != '\n' && buffer_[at] != '\r' && buffer_[at] != '\0')))
            ++at;
        if (at < end_ && buffer_[at] == '\0')
            throw SceneFileError(path_ + ": line " + std::to_string(count_ + 1) +
                                 ": holds a null character; expected text");
        if (at == end_) {
            searched = at - begin_;
            check_length(searched);
            if (read_more()) continue;
            if (begin_ == end_) return false;
            at = end_;
        }
        line = std::string_view(buffer_.data() + begin_, at - begin_);
        after_return_ = at < end_ && buffer_[at] == '\r';
        begin_ = std::min(at + 1, end_);
        ++count_;
        return true;
    }
}

bool TextLines::next(std::string_view& line) {
    if (!next_physical(line)) return false;
    number_ = count_;
    if (!line.ends_with('\\')) return true;
    joined_.clear();
    while (line.ends_with('\\')) {
        joined_.append(line.substr(0, line.size() - 1)).append(" ");
        check_length(joined_.size());
        line = {};
        if (!next_physical(line)) break;
    }
    joined_.append(line);
    line = joined_;
    return true;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view take_word(std::string_view& line) {
    std::size_t begin = 0;
    while (begin < line.size() && is_blank(line[begin])) ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_blank(line[end])) ++end;
    const std::string_view word = line.substr(begin, end - begin);
    while (end < line.size() && is_blank(line[end])) ++end;
    line.remove_prefix(end);
    return word;
}

}  // namespace realcam::io
