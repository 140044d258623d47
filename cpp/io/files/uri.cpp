#include "uri.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace realcam::io {
namespace {

/// Value of a hexadecimal digit; -1 for another character.
int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

constexpr int kInvalidDigit = -1;

constexpr std::array<int, 256> base64_digits() {
    std::array<int, 256> digits{};
    digits.fill(kInvalidDigit);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i)
        digits[static_cast<unsigned char>(alphabet[i])] = static_cast<int>(i);
    return digits;
}

/// Returns std::nullopt if the text is not base64.
std::optional<std::string> base64_decoded(std::string_view text) {
    static constexpr std::array<int, 256> digits = base64_digits();
    while (text.ends_with('=')) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string out;
    out.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = digits[static_cast<unsigned char>(c)];
        if (digit == kInvalidDigit) return std::nullopt;
        bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xffffff;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        out += static_cast<char>(bits >> count & 0xff);
    }
    return out;
}

}  // namespace

std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
            out += static_cast<char>(16 * hex_digit(text[i + 1]) + hex_digit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

std::optional<std::string> data_of_uri(std::string_view uri) {
    constexpr std::string_view marker = ";base64,";
    // The media type before the marker is short: a long text without it need not be searched to its end.
    const std::size_t begin = uri.substr(0, 1000).find(marker);
    if (!is_data_uri(uri) || begin == std::string_view::npos) return std::nullopt;
    return base64_decoded(uri.substr(begin + marker.size()));
}

std::optional<std::string> find_beside(const std::string& scene_path, const std::string& name) {
    namespace fs = std::filesystem;
    // No system has longer paths, and a name with a null character would be truncated at it.
    constexpr std::size_t kMaxPath = 4096;
    if (name.empty() || name.size() > kMaxPath || name.find('\0') != std::string::npos) return std::nullopt;
    const fs::path folder = fs::path(scene_path).parent_path();
    std::string slashes = name;
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    for (const std::string& spelling : {name, slashes, percent_decoded(slashes)}) {
        if (spelling.find('\0') != std::string::npos) continue;
        for (const fs::path& candidate : {folder / spelling, folder / fs::path(spelling).filename()}) {
            std::error_code error;
            if (fs::is_regular_file(candidate, error)) return candidate.string();
        }
    }
    return std::nullopt;
}

std::string suffix_of(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return suffix;
}

}  // namespace realcam::io
