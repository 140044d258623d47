#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Values of a picture, shared between copies. They start uninitialised, because all of them are written, and may lie
/// in memory that a GPU writes at full speed.
class PictureFloats {
public:
    PictureFloats() = default;
    explicit PictureFloats(std::size_t size) : PictureFloats(std::make_shared_for_overwrite<float[]>(size), size) {}
    PictureFloats(std::shared_ptr<float[]> data, std::size_t size) : data_(std::move(data)), size_(size) {}
    explicit PictureFloats(std::span<const float> values) : PictureFloats(values.size()) {
        std::copy(values.begin(), values.end(), begin());
    }

    float* data() const { return data_.get(); }
    std::size_t size() const { return size_; }
    float* begin() const { return data(); }
    float* end() const { return data() + size_; }
    float& operator[](std::size_t i) const { return data()[i]; }

private:
    std::shared_ptr<float[]> data_;
    std::size_t size_ = 0;
};

}  // namespace REALCAM_NAMESPACE
