#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gltf_buffers.hpp"

namespace realcam::io {

/// Values of an accessor's componentType.
enum GltfComponentType : std::size_t {
    kGltfByte = 5120,
    kGltfUnsignedByte = 5121,
    kGltfShort = 5122,
    kGltfUnsignedShort = 5123,
    kGltfUnsignedInt = 5125,
    kGltfFloat = 5126
};

/// Number of components of an element of an accessor's type, such as 3 for "VEC3".
std::size_t components_of(std::string_view type);

/// Elements of accessors that come from a compressed mesh, by the accessor's index. They are stored without padding.
struct DecodedElements {
    std::string bytes;
    std::size_t component_type;  ///< see GltfComponentType
};
using DecodedAccessors = std::map<std::size_t, DecodedElements>;

/// Reads the numbers of a glTF's accessors: of any component type, with normalised integers converted to fractions and
/// sparse accessors assembled.
class GltfAccessors {
public:
    /// All arguments must outlive the object.
    GltfAccessors(const GltfDocument& document, GltfBuffers& buffers, Checkpoint& checkpoint)
        : document_(document), buffers_(buffers), checkpoint_(checkpoint) {}

    /// Returns all elements of an accessor, one after the other: three numbers each for `type` "VEC3". `reference`:
    /// JSON number with the accessor's index. Throws SceneFileError, whose message begins with `where`, if the accessor
    /// or its bytes do not exist or if it is of another type.
    std::vector<float> numbers(const Json& reference, const std::string& type, const std::string& where);

    /// Returns all elements as whole numbers, like numbers(). Throws SceneFileError also for an accessor of floats.
    std::vector<std::uint32_t> integers(const Json& reference, const std::string& type, const std::string& where);

    /// Sets elements that replace those of their accessors, until the next call.
    void set_decoded(DecodedAccessors decoded) { decoded_ = std::move(decoded); }

    /// Returns the number of elements that an accessor declares; 0 if it does not exist.
    std::size_t count(const Json& reference) const;

private:
    template <class Value>
    std::vector<Value> read(const Json& reference, const std::string& type, const std::string& where);
    /// Replaces the elements that a sparse accessor lists.
    template <class Value>
    void read_sparse(const Json& accessor, std::size_t components, const std::string& where,
                     std::vector<Value>& values);

    const GltfDocument& document_;
    GltfBuffers& buffers_;
    Checkpoint& checkpoint_;
    DecodedAccessors decoded_;
};

}  // namespace realcam::io
