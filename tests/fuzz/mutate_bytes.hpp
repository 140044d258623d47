#pragma once
// Mutations of bytes that know nothing of what they mean.

#include <algorithm>
#include <cstdint>
#include <string>

#include "bytes.hpp"

namespace realcam::fuzz {

inline void mutate_bytes(Bytes& in, std::string& bytes) {
    if (bytes.empty()) bytes = "\n";
    const std::size_t at = in.word() % bytes.size();
    const std::size_t length = std::min<std::size_t>(1 + static_cast<std::size_t>(in.below(32)), bytes.size() - at);
    switch (in.below(8)) {
        case 0: bytes[at] = static_cast<char>(in.byte()); return;
        case 1: bytes[at] = static_cast<char>(bytes[at] ^ (1 << in.below(8))); return;
        case 2: {  // a number at an extreme, in 1 to 8 bytes, whichever end comes first
            static constexpr unsigned char ends[] = {0, 1, 0x7f, 0x80, 0xff};
            const unsigned char first = ends[in.below(5)], others = ends[in.below(5)];
            for (std::size_t i = 0; i < std::min<std::size_t>(length, 8); ++i)
                bytes[at + i] = static_cast<char>(i == 0 ? first : others);
            return;
        }
        case 3: bytes.erase(at, length); return;
        case 4: bytes.insert(at, bytes.substr(in.word() % bytes.size(), length)); return;
        case 5: bytes.replace(at, length, bytes.substr(in.word() % bytes.size(), length)); return;
        case 6: {  // a number a little larger or smaller
            bytes[at] = static_cast<char>(bytes[at] + in.below(16) - 8);
            return;
        }
        default: bytes.resize(at); return;
    }
}

}  // namespace realcam::fuzz
