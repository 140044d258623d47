#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "../../render/film/image.hpp"
#include "../device/device_array.hpp"

namespace realcam {

/// Pool of host memory for the arrays of pictures, which is reused after a picture is released. Pinning memory takes
/// longer than copying one picture, so memory is pinned only from the second picture of a size on.
class PicturePool {
public:
    /// Returns an array of a size that no picture uses.
    PictureFloats acquire(std::size_t size) {
        if (size != size_) {
            size_ = size;
            arrays_.clear();
            return PictureFloats(size);
        }
        for (const auto& array : arrays_)
            if (array.use_count() == 1) return floats_of(array);
        if (arrays_.size() == kMaxPinned) return PictureFloats(size);
        return floats_of(arrays_.emplace_back(std::make_shared<PinnedArray<float>>(size)));
    }

private:
    /// Limit of pinned arrays: pinned memory cannot be paged out, and a caller may keep many pictures.
    static constexpr std::size_t kMaxPinned = 3;

    static PictureFloats floats_of(const std::shared_ptr<PinnedArray<float>>& array) {
        return {std::shared_ptr<float[]>(array, array->data()), array->size()};
    }

    std::vector<std::shared_ptr<PinnedArray<float>>> arrays_;
    std::size_t size_ = 0;  ///< size of the last array
};

}  // namespace realcam
