#pragma once
// The bytes of a fuzz input as decisions and numbers.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "math/random.hpp"

namespace realcam::fuzz {

/// Draws numbers from fuzz bytes. After the last byte, numbers are hashes of all bytes: a short input still describes a
/// whole lens with all its rays, and a search that changes one byte changes little before that byte's position.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {
        for (std::size_t i = 0; i < size; ++i) seed_ = hash32(data[i] + 0x100u * static_cast<unsigned>(i), seed_);
    }

    std::uint32_t word() {
        if (left_ < sizeof(std::uint32_t)) return hash32(++count_, seed_);
        std::uint32_t value;
        std::memcpy(&value, data_, sizeof value);
        data_ += sizeof value;
        left_ -= sizeof value;
        return value;
    }
    std::uint32_t byte() {
        if (left_ == 0) return hash32(++count_, seed_) >> 24;
        --left_;
        return *data_++;
    }

    /// 0 to n - 1; n is at most 256.
    int below(int n) { return static_cast<int>(byte() * static_cast<unsigned>(n) >> 8); }
    /// True n times in 256.
    bool chance(int n) { return static_cast<int>(byte()) < n; }
    double sign() { return chance(128) ? 1 : -1; }

    /// In [0, 1).
    double unit() { return word() * 0x1p-32; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// Even in the exponent.
    double decades(double low, double high) { return std::pow(10.0, between(low, high)); }

    /// Any number at all: what a file or a caller may hold.
    double any() {
        using Limits = std::numeric_limits<double>;
        static constexpr double special[] = {0.0,
                                             -0.0,
                                             1.0,
                                             -1.0,
                                             Limits::denorm_min(),
                                             Limits::min(),
                                             Limits::max(),
                                             Limits::lowest(),
                                             Limits::infinity(),
                                             -Limits::infinity(),
                                             Limits::quiet_NaN(),
                                             Limits::epsilon(),
                                             1 - 0x1p-53,
                                             1 + 0x1p-52,
                                             0x1p24,
                                             3.5e38,
                                             1e-46,
                                             1e18,
                                             1.0000000001e18,
                                             -1e18};
        switch (below(4)) {
            case 0: return special[below(static_cast<int>(sizeof special / sizeof *special))];
            case 1: return sign() * decades(-320, 308);
            case 2: return sign() * decades(-6, 6);
            default: {
                const std::uint64_t bits = static_cast<std::uint64_t>(word()) << 32 | word();
                double value;
                std::memcpy(&value, &bits, sizeof value);
                return value;
            }
        }
    }

    /// The next number up or down, or a few from there.
    double nudged(double value) {
        const int steps = below(4);
        const double towards = sign() * std::numeric_limits<double>::infinity();
        for (int i = 0; i < steps; ++i) value = std::nextafter(value, towards);
        return value;
    }

private:
    const std::uint8_t* data_;
    std::size_t left_;
    std::uint32_t seed_ = 0x51ed270bu, count_ = 0;
};

}  // namespace realcam::fuzz
