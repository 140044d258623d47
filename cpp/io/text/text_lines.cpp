#include "text_lines.hpp"

#include <algorithm>
#include <cstring>

namespace realcam::io {
namespace {

constexpr std::size_t kChunk = 1 << 20;  // bytes read at a time
/// Allows a polygon of tens of millions of corners, but not a file without lines.
constexpr std::size_t kMaxLineLength = std::size_t{1} << 28;
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
    if (buffer_.size() - end_ < kChunk) buffer_.resize(std::max(2 * buffer_.size(), kChunk + end_));
    const std::size_t n = file_.read(buffer_.data() + end_, kChunk);
    checkpoint_.pass(n / 64);
    end_ += n;
    return n > 0;
}

void TextLines::check_length(std::size_t length) const {
    if (length <= kMaxLineLength) return;
    throw SceneFileError(path_ + ": line " + std::to_string(count_ + 1) + ": is longer than " +
                         std::to_string(kMaxLineLength) + " bytes");
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
        std::size_t position = begin_ + searched;
        // The characters that end a line, and the null character, are at most '\r'.
        while (position < end_ &&
               (static_cast<unsigned char>(buffer_[position]) > '\r' ||
                (buffer_[position] != '\n' && buffer_[position] != '\r' && buffer_[position] != '\0')))
            ++position;
        if (position < end_ && buffer_[position] == '\0')
            throw SceneFileError(path_ + ": line " + std::to_string(count_ + 1) +
                                 ": holds a null character; expected text");
        if (position == end_) {
            searched = position - begin_;
            check_length(searched);
            if (read_more()) continue;
            if (begin_ == end_) return false;
            position = end_;
        }
        line = std::string_view(buffer_.data() + begin_, position - begin_);
        after_return_ = position < end_ && buffer_[position] == '\r';
        begin_ = std::min(position + 1, end_);
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

std::string_view consume_word(std::string_view& line) {
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
