#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gltf_buffers.hpp"

namespace realcam::io {

/// The numbers of a glTF's accessors: of any component type, normalised integers as what they stand for, sparse ones
/// put together.
class GltfAccessors {
public:
    /// All arguments have to outlive it.
    GltfAccessors(const GltfDocument& document, GltfBuffers& buffers, Checkpoint& checkpoint)
        : document_(document), buffers_(buffers), checkpoint_(checkpoint) {}

    /// All elements, one after the other: for `type` "VEC3" three numbers each. Throws SceneFileError, which begins
    /// with `where`, if the accessor does not exist, is of another type, or its bytes do not.
    std::vector<float> numbers(const Json& reference, const std::string& type, const std::string& where);

    /// The same for whole numbers, which no accessor of floats has.
    std::vector<std::uint32_t> integers(const Json& reference, const std::string& type, const std::string& where);

    /// Elements that an accessor promises; 0 where it does not exist.
    std::size_t count(const Json& reference) const;

private:
    template <class Value>
    std::vector<Value> read(const Json& reference, const std::string& type, const std::string& where);
    template <class Value>
    void read_sparse(const Json& accessor, std::size_t components, const std::string& where,
                     std::vector<Value>& values);

    const GltfDocument& document_;
    GltfBuffers& buffers_;
    Checkpoint& checkpoint_;
};

}  // namespace realcam::io
