#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace realcam {

/// Returns the ordinal of the GPU whose memory holds an address; std::nullopt for host memory. Throws DeviceError if
/// there is no GPU.
std::optional<int> gpu_of_address(const void* address);

/// Waits for a stream of the GPU, or without one for the whole device. `stream`: its handle, or 1 or 2 for the legacy
/// and the per-thread default stream. Throws DeviceError.
void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream);

/// Type of an array's elements.
enum class NumberType { float32, float64, int32, uint8 };

/// Returns the size of an element in bytes.
constexpr std::size_t size_of(NumberType type) {
    return type == NumberType::float64 ? 8 : type == NumberType::uint8 ? 1 : 4;
}

/// Array in a GPU's memory, in C order, that can be shared with other libraries. Copies share the memory; the last copy
/// to be destroyed frees it, on whatever thread that is. All writes to the array have completed before it is
/// constructed.
class SharedDeviceArray {
public:
    /// `ordinal`: of the GPU; `shape`: number of elements along each axis. The deleter of `memory` must not throw. For
    /// a DeviceArray, use share() in share_array.hpp.
    SharedDeviceArray(std::shared_ptr<void> memory, int ordinal, NumberType type, std::vector<std::int64_t> shape)
        : memory_(std::move(memory)), ordinal_(ordinal), type_(type), shape_(std::move(shape)) {}

    const std::shared_ptr<void>& memory() const { return memory_; }
    void* data() const { return memory_.get(); }
    int ordinal() const { return ordinal_; }
    NumberType type() const { return type_; }
    const std::vector<std::int64_t>& shape() const { return shape_; }
    std::size_t bytes() const {
        std::size_t product = size_of(type_);
        for (const std::int64_t extent : shape_) product *= static_cast<std::size_t>(extent);
        return product;
    }

    /// Copies the whole array to host memory, of bytes() bytes. Throws DeviceError.
    void download(void* to) const;
    /// Returns a deep copy on the same GPU. Throws DeviceError.
    SharedDeviceArray duplicate() const;

private:
    std::shared_ptr<void> memory_;
    int ordinal_;
    NumberType type_;
    std::vector<std::int64_t> shape_;
};

}  // namespace realcam
