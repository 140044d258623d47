#pragma once
#include <vector>

#include "device_array.hpp"

namespace realcam {

/// Arrays of any type on one device. Allocations are reused after restart().
class DeviceArrays {
public:
    /// Makes subsequent copies overwrite the previous ones.
    void restart() { next_ = 0; }

    template <class T>
    const T* copy(const T* from, std::size_t count, cudaStream_t stream) {
        if (next_ == arrays_.size()) arrays_.emplace_back();
        DeviceArray<unsigned char>& array = arrays_[next_++];
        array.upload(reinterpret_cast<const unsigned char*>(from), count * sizeof(T), stream);
        return reinterpret_cast<const T*>(array.data());
    }

private:
    std::vector<DeviceArray<unsigned char>> arrays_;
    std::size_t next_ = 0;
};

}  // namespace realcam
