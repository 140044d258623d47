#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "../../render/film/image.hpp"
#include "../device/device_array.hpp"

namespace realcam {

/// Pool of host memory for pictures, reused when a picture is released. Pinning takes longer than copying one picture,
/// so memory is pinned only from the second picture of a size on.
class PicturePool {
public:
    PictureFloats take(std::size_t size) {
        if (size != size_) {
            size_ = size;
            arrays_.clear();
            return PictureFloats(size);
        }
        for (const auto& array : arrays_)
            if (array.use_count() == 1) return floats_of(array);
        if (arrays_.size() == kMost) return PictureFloats(size);
        return floats_of(arrays_.emplace_back(std::make_shared<PinnedArray<float>>(size)));
    }

private:
    /// Limit of pinned arrays, so that a caller who keeps many pictures does not hold all of them in memory that cannot
    /// be paged out.
    static constexpr std::size_t kMost = 3;

    static PictureFloats floats_of(const std::shared_ptr<PinnedArray<float>>& array) {
        return {std::shared_ptr<float[]>(array, array->data()), array->size()};
    }

    std::vector<std::shared_ptr<PinnedArray<float>>> arrays_;
    std::size_t size_ = 0;
};

}  // namespace realcam
