#include "obj_numbers.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <cstdint>

#include <fstream>
#include <iterator>
#include <utility>

namespace realcam::io {
namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// The same text if there is nothing to mend. Only lines of numbers: a file name may begin with a dot.
std::string with_leading_zeros(const std::string& text) {
    std::string out;
    std::size_t copied = 0;
    for (std::size_t dot = text.find('.'); dot != std::string::npos; dot = text.find('.', dot + 1)) {
        if (dot == 0 || !is_space(text[dot - 1]) || dot + 1 == text.size() || !is_digit(text[dot + 1])) continue;
        const std::size_t end = text.rfind('\n', dot);
        if (text[text.find_first_not_of(" \t", end == std::string::npos ? 0 : end + 1)] != 'v') continue;
        out.append(text, copied, dot - copied).append("0");
        copied = dot;
    }
    return out.append(text, copied);
}

class MendedFile final : public Assimp::DefaultIOSystem {
public:
    MendedFile(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {}

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (path_ != name) return DefaultIOSystem::Open(name, mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()), text_.size());
    }

private:
    std::string path_, text_;
};

}  // namespace

void mend_obj_numbers(Assimp::Importer& importer, const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    std::string mended = with_leading_zeros(text);
    if (mended.size() != text.size()) importer.SetIOHandler(new MendedFile(path, std::move(mended)));
}

}  // namespace realcam::io
