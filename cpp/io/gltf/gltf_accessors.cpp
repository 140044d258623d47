#include "gltf_accessors.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace realcam::io {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Greatest number of elements of an accessor without a bufferView, whose elements are 0 except for the sparse ones.
constexpr std::size_t kMaxWithoutBytes = std::size_t{1} << 20;

/// Array of elements of one component type.
struct Elements {
    std::string_view bytes;
    std::size_t component_type;  ///< see GltfComponentType
    std::size_t components;  ///< components of each element
    std::size_t count;  ///< number of elements
    std::size_t stride;  ///< distance between elements in bytes
    bool normalised;  ///< integers are fractions of the largest integer
};

/// Size of a component type in bytes; 0 for invalid types.
std::size_t size_of_component(std::size_t type) {
    switch (type) {
        case kGltfByte:
        case kGltfUnsignedByte: return 1;
        case kGltfShort:
        case kGltfUnsignedShort: return 2;
        case kGltfUnsignedInt:
        case kGltfFloat: return 4;
        default: return 0;
    }
}

/// Converts a stored component. A normalised signed integer maps to -1 to 1, an unsigned one to 0 to 1.
template <class Stored, class Value>
Value value_of(Stored stored, bool normalised) {
    if constexpr (std::is_same_v<Value, float> && std::is_integral_v<Stored>) {
        if (normalised) {
            const float fraction = static_cast<float>(stored) / static_cast<float>(std::numeric_limits<Stored>::max());
            return std::max(fraction, -1.0f);
        }
    }
    return static_cast<Value>(stored);
}

/// Appends the components of all elements, converted from their type Stored.
template <class Stored, class Value>
void copy_elements(const Elements& from, std::vector<Value>& to, Checkpoint& checkpoint) {
    for (std::size_t i = 0; i < from.count; ++i) {
        const char* element = from.bytes.data() + i * from.stride;
        for (std::size_t c = 0; c < from.components; ++c) {
            Stored stored;
            std::memcpy(&stored, element + c * sizeof stored, sizeof stored);
            to.push_back(value_of<Stored, Value>(stored, from.normalised));
        }
        checkpoint.pass();
    }
}

/// Returns the components of all elements.
template <class Value>
std::vector<Value> values_of(const Elements& from, Checkpoint& checkpoint) {
    std::vector<Value> to;
    to.reserve(from.count * from.components);
    switch (from.component_type) {
        case kGltfByte: copy_elements<std::int8_t>(from, to, checkpoint); break;
        case kGltfUnsignedByte: copy_elements<std::uint8_t>(from, to, checkpoint); break;
        case kGltfShort: copy_elements<std::int16_t>(from, to, checkpoint); break;
        case kGltfUnsignedShort: copy_elements<std::uint16_t>(from, to, checkpoint); break;
        case kGltfUnsignedInt: copy_elements<std::uint32_t>(from, to, checkpoint); break;
        default:
            // Floats instead of integers have been rejected by element_size.
            if constexpr (std::is_same_v<Value, float>) copy_elements<float>(from, to, checkpoint);
    }
    return to;
}

/// Returns the size of an element in bytes. Throws SceneFileError, whose message begins with `where`, for a component
/// type that is invalid for numbers of type Value.
template <class Value>
std::size_t element_size(const GltfDocument& document, std::size_t component_type, std::size_t components,
                         const std::string& where) {
    const std::size_t size = size_of_component(component_type) * components;
    if (size == 0 || (component_type == kGltfFloat && !std::is_same_v<Value, float>))
        document.fail(where + ": its componentType is not valid here");
    return size;
}

/// Reads elements through a buffer view. `from`: an accessor, or the indices or values of a sparse one, with bufferView
/// and byteOffset. Throws SceneFileError, whose message begins with `where`.
template <class Value>
std::vector<Value> read_view(const GltfDocument& document, GltfBuffers& buffers, Checkpoint& checkpoint,
                             const Json& from, std::size_t components, std::size_t count, const Json& component_type,
                             bool normalised, const std::string& where) {
    const std::size_t type = component_type.index(0), size = element_size<Value>(document, type, components, where);
    std::string_view bytes = buffers.view(from["bufferView"], where);
    const std::size_t offset = from["byteOffset"].index(0);
    const Json& view = document.root()["bufferViews"][from["bufferView"].index(0)];
    const std::size_t byte_stride = view["byteStride"].index(0), stride = byte_stride > 0 ? byte_stride : size;
    const std::size_t available = offset <= bytes.size() ? bytes.size() - offset : 0;
    // Rejects a byteStride less than the size of an element, with which elements would overlap.
    if (stride < size || (count > 0 && (available < size || count - 1 > (available - size) / stride)))
        document.fail(where + ": promises " + std::to_string(count) + " elements of " + std::to_string(size) +
                      " bytes, and its bufferView has " + std::to_string(available) + " bytes for them");
    return values_of<Value>({bytes.substr(std::min(offset, bytes.size())), type, components, count, stride, normalised},
                            checkpoint);
}

}  // namespace

std::size_t components_of(std::string_view type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    return type == "MAT4" ? 16 : 4;
}

std::size_t GltfAccessors::count(const Json& reference) const {
    const Json& accessors = document_.root()["accessors"];
    return accessors[reference.index(accessors.size())]["count"].index(0);
}

template <class Value>
void GltfAccessors::read_sparse(const Json& accessor, std::size_t components, const std::string& where,
                                std::vector<Value>& values) {
    const Json &sparse = accessor["sparse"], &indices = sparse["indices"];
    const std::size_t count = sparse["count"].index(0), elements = values.size() / components;
    const std::vector<std::uint32_t> sparse_indices =
        read_view<std::uint32_t>(document_, buffers_, checkpoint_, indices, 1, count, indices["componentType"], false,
                                 where + ": its sparse indices");
    const std::vector<Value> replacements =
        read_view<Value>(document_, buffers_, checkpoint_, sparse["values"], components, count,
                         accessor["componentType"], accessor["normalized"].is_true(), where + ": its sparse values");
    for (std::size_t i = 0; i < count; ++i) {
        if (sparse_indices[i] >= elements)
            document_.fail(where + ": its sparse index " + std::to_string(sparse_indices[i]) +
                           " is not smaller than the number of elements, " + std::to_string(elements));
        std::copy_n(replacements.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                    values.begin() + static_cast<std::ptrdiff_t>(sparse_indices[i] * components));
    }
}

template <class Value>
std::vector<Value> GltfAccessors::read(const Json& reference, const std::string& type, const std::string& use) {
    const std::optional<std::size_t> index = document_.find("accessors", reference, use);
    if (!index) document_.fail(use + ": names no accessor");
    const std::string where = use + ": accessor " + std::to_string(*index);
    const Json& accessor = document_.root()["accessors"][*index];
    if (accessor["type"].text() != type) document_.fail(where + ": expected elements of type " + type);
    const std::size_t count = accessor["count"].index(0), components = components_of(type);
    if (const auto decoded = decoded_.find(*index); decoded != decoded_.end()) {
        const auto& [bytes, component_type] = decoded->second;
        const std::size_t size = element_size<Value>(document_, component_type, components, where);
        if (bytes.size() / size != count)
            document_.fail(where + ": has " + std::to_string(count) + " elements, and its compressed mesh " +
                           std::to_string(bytes.size() / size));
        return values_of<Value>({bytes, component_type, components, count, size, accessor["normalized"].is_true()},
                                checkpoint_);
    }
    std::vector<Value> values;
    if (!accessor["bufferView"].is_null())
        values = read_view<Value>(document_, buffers_, checkpoint_, accessor, components, count,
                                  accessor["componentType"], accessor["normalized"].is_true(), where);
    else if (count > kMaxWithoutBytes)
        document_.fail(where + ": promises " + std::to_string(count) + " elements and has no bytes for them");
    else
        values.assign(count * components, Value(0));
    if (!accessor["sparse"].is_null()) read_sparse(accessor, components, where, values);
    return values;
}

std::vector<float> GltfAccessors::numbers(const Json& reference, const std::string& type, const std::string& where) {
    return read<float>(reference, type, where);
}

std::vector<std::uint32_t> GltfAccessors::integers(const Json& reference, const std::string& type,
                                                   const std::string& where) {
    return read<std::uint32_t>(reference, type, where);
}

}  // namespace realcam::io
