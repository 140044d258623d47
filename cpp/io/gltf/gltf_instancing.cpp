#include "gltf_instancing.hpp"

#include <algorithm>

#include "../../math/quaternion.hpp"
#include "../scene/file_motion.hpp"

namespace realcam::io {
namespace {

/// Greatest number of instances per node: in a file of a megabyte, a thousand nodes may share a million transforms.
constexpr std::size_t kMost = std::size_t{1} << 21;

}  // namespace

std::vector<Affine<double>> instances_of(const Json& node, GltfAccessors& accessors, const GltfDocument& document,
                                         const std::string& label) {
    const Json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    std::size_t count = 0;
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"})
        if (!attributes[name].is_null()) count = std::max(count, accessors.count(attributes[name]));
    if (count > kMost)
        document.fail(label + ": has " + std::to_string(count) + " instances; at most " + std::to_string(kMost) +
                      " are read");
    const auto read = [&](const char* name, const char* type, std::size_t components) {
        std::vector<float> numbers;
        if (attributes[name].is_null()) return numbers;
        const std::string where = label + ": " + name + " of its instances";
        numbers = accessors.numbers(attributes[name], type, where);
        if (numbers.size() != components * count)
            document.fail(where + ": has " + std::to_string(numbers.size() / components) + " elements for " +
                          std::to_string(count) + " instances; one for each is wanted");
        return numbers;
    };
    const std::vector<float> translations = read("TRANSLATION", "VEC3", 3), rotations = read("ROTATION", "VEC4", 4),
                             scales = read("SCALE", "VEC3", 3);
    const auto vector = [](const std::vector<float>& numbers, std::size_t at) {
        return static_cast<Vec3d>(Vec3f{numbers[at], numbers[at + 1], numbers[at + 2]});
    };
    std::vector<Affine<double>> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        FileMotion transform;
        if (!translations.empty()) transform.translation = vector(translations, 3 * i);
        if (!scales.empty()) transform.scale = vector(scales, 3 * i);
        if (!rotations.empty()) {
            const Quaternion turn = {vector(rotations, 4 * i), static_cast<double>(rotations[4 * i + 3])};
            if (dot(turn, turn) > 0) transform.rotation = turn;
        }
        out.push_back(transform.parent_from_node(0));
    }
    return out;
}

}  // namespace realcam::io
