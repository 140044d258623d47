#include "gltf_readers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../../math/motion.hpp"
#include "../text/printable.hpp"
#include "gltf_nodes.hpp"

namespace realcam::io {
namespace {

/// Reads the file's animations, which play together. A property of a node follows the first animation that has a
/// channel for it.
class AnimationReader {
public:
    AnimationReader(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                    const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint)
        : scene_(scene), document_(document), accessors_(accessors), checkpoint_(checkpoint) {
        for (std::size_t i = 0; i < file_indices.size(); ++i) node_index_[file_indices[i]] = i;
    }

    GltfTargetWeights read() {
        const std::size_t count = document_.root()["animations"].size();
        for (index_ = 0; index_ < count; ++index_) read_channels();
        remove_constant_motions();
        warn_of_left_out();
        return std::move(target_weights_);
    }

private:
    const Json& animation() const { return document_.root()["animations"][index_]; }

    void read_channels() {
        const Json& channels = animation()["channels"];
        const std::string label = gltf_label("animation", index_, animation());
        std::size_t other_paths = 0, without_targets = 0,
                    with_matrix = 0;  // numbers of channels that are not supported
        bool is_left_out = false;  // a channel, because an earlier animation has one of the same property
        for (std::size_t c = 0; c < channels.size(); ++c) {
            checkpoint_.pass();
            const Json& target = channels[c]["target"];
            const std::string& path = target["path"].text();
            const std::string where = label + ": channel " + std::to_string(c);
            const std::optional<std::size_t> node = document_.find("nodes", target["node"], where + ": its node");
            if (!node || !node_index_.contains(*node)) continue;
            const bool has_weights = path == "weights";
            if (!has_weights && path != "translation" && path != "rotation" && path != "scale") {
                ++other_paths;
            } else if (has_weights && target_count(*node) == 0) {
                ++without_targets;
            } else if (!has_weights && !document_.root()["nodes"][*node]["matrix"].is_null()) {
                ++with_matrix;
            } else if (animation_of_.try_emplace({*node, path}, index_).first->second != index_) {
                is_left_out = true;
            } else if (has_weights) {
                const auto keys = keys_of(channels[c]["sampler"], "SCALAR", target_count(*node), where);
                target_weights_[*node] = {keys, changes(keys)};
            } else {
                const std::size_t components = path == "rotation" ? 4 : 3;
                set_keys(*node, path,
                         keys_of(channels[c]["sampler"], components == 4 ? "VEC4" : "VEC3", components, where));
            }
        }
        if (is_left_out) left_out_.push_back(index_);
        const auto warn = [&](std::size_t number, const std::string& problem) {
            if (number > 0) scene_.warnings.push_back(label + ": " + std::to_string(number) + ' ' + problem);
        };
        warn(other_paths, "channels animate something else than translation, rotation, scale and weights");
        warn(without_targets, "channels animate the weights of a mesh without morph targets");
        warn(with_matrix, "channels animate nodes that have a matrix, which remain static");
    }

    /// Adds one warning that names the animations with channels that are not played.
    void warn_of_left_out() {
        if (left_out_.empty()) return;
        constexpr std::size_t kMaxNamed = 8;
        std::string names;
        for (std::size_t i = 0; i < std::min(left_out_.size(), kMaxNamed); ++i)
            names += (i == 0 ? "" : ", ") +
                     gltf_label("animation", left_out_[i], document_.root()["animations"][left_out_[i]]);
        if (left_out_.size() > kMaxNamed) names += " and " + std::to_string(left_out_.size() - kMaxNamed) + " more";
        scene_.warnings.push_back(names + ": channels for properties that an earlier animation moves are not played");
    }

    /// Returns the number of morph targets of a node's mesh. `node`: index in the file.
    std::size_t target_count(std::size_t node) const {
        const Json& meshes = document_.root()["meshes"];
        const Json& mesh = meshes[document_.root()["nodes"][node]["mesh"].index(meshes.size())];
        return mesh["primitives"][std::size_t{0}]["targets"].size();
    }

    /// Animates a node. `index`: of the node in the file; `path`: translation, rotation or scale.
    void set_keys(std::size_t index, const std::string& path, std::shared_ptr<const VectorKeys> keys) {
        FileNode& node = scene_.nodes[node_index_[index]];
        if (node.motion < 0) {
            node.motion = static_cast<std::int32_t>(scene_.motions.size());
            scene_.motions.push_back(static_motion(document_.root()["nodes"][index]));
        }
        NodeMotion& motion = scene_.motions[static_cast<std::size_t>(node.motion)];
        (path == "translation" ? motion.translation_keys
         : path == "rotation"  ? motion.rotation_keys
                               : motion.scale_keys) = std::move(keys);
    }

    /// Removes motions that are constant: many programs write keys for every node, also for those that never move.
    void remove_constant_motions() {
        for (FileNode& node : scene_.nodes) {
            if (node.motion < 0) continue;
            checkpoint_.pass();
            const NodeMotion& motion = scene_.motions[static_cast<std::size_t>(node.motion)];
            if (changes(motion.translation_keys) || changes(motion.rotation_keys) || changes(motion.scale_keys))
                continue;
            node.parent_from_node = motion.parent_from_node(0);
            node.motion = -1;
        }
    }

    /// True if keys are not constant.
    bool changes(const std::shared_ptr<const VectorKeys>& keys) {
        if (!keys) return false;
        const auto [known, is_new] = changes_.try_emplace(keys.get());
        if (is_new) known->second = keys->changes();
        return known->second;
    }

    /// Returns the keys of a sampler, which is read on first use. `type`: of its output's accessor; `components`:
    /// numbers of a vector.
    std::shared_ptr<const VectorKeys> keys_of(const Json& reference, const std::string& type, std::size_t components,
                                              const std::string& where) {
        const Json& samplers = animation()["samplers"];
        const std::size_t index = reference.index(samplers.size());
        if (index >= samplers.size()) document_.fail(where + ": its sampler does not exist");
        const auto [known, is_new] = samplers_.try_emplace({index_, index, components, type});
        if (is_new) known->second = read_sampler(samplers[index], type, components, where);
        return known->second;
    }

    std::shared_ptr<const VectorKeys> read_sampler(const Json& sampler, const std::string& type, std::size_t components,
                                                   const std::string& where) {
        auto keys = std::make_shared<VectorKeys>();
        keys->components = components;
        const std::string& interpolation = sampler["interpolation"].text();
        if (interpolation == "STEP") {
            keys->interpolation = KeyInterpolation::step;
        } else if (interpolation == "CUBICSPLINE") {
            keys->interpolation = KeyInterpolation::cubic_spline;
        } else if (!interpolation.empty() && interpolation != "LINEAR") {
            document_.fail(where + ": its interpolation is " + in_quotes(interpolation.substr(0, 60)) +
                           "; expected LINEAR, STEP or CUBICSPLINE");
        }
        for (const float time : accessors_.numbers(sampler["input"], "SCALAR", where + ": its input")) {
            const auto seconds = static_cast<double>(time);
            if (!(std::fabs(seconds) <= kMaxTime_s)) document_.fail(where + ": a time must lie within 1e9 s");
            if (!keys->times.empty() && !(keys->times.back() < seconds))
                document_.fail(where + ": its times must be strictly increasing");
            keys->times.push_back(seconds);
        }
        keys->values = accessors_.numbers(sampler["output"], type, where + ": its output");
        for (const float value : keys->values)
            if (!std::isfinite(value)) document_.fail(where + ": its output holds a number that is not finite");
        const std::size_t values_per_time = keys->interpolation == KeyInterpolation::cubic_spline ? 3 : 1;
        if (keys->times.empty() || keys->values.size() != keys->times.size() * values_per_time * components)
            document_.fail(where + ": has " + std::to_string(keys->times.size()) + " times and " +
                           std::to_string(keys->values.size() / components) + " values; expected " +
                           std::to_string(values_per_time) + " for each time");
        return keys;
    }

    FileScene& scene_;
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    Checkpoint& checkpoint_;
    std::size_t index_ = 0;  ///< the animation that is read
    std::map<std::size_t, std::size_t> node_index_;  ///< index in the scene of each node of the file
    GltfTargetWeights target_weights_;
    /// Index of the first animation with a channel for a property, by index of the node in the file, and path.
    std::map<std::pair<std::size_t, std::string>, std::size_t> animation_of_;
    std::vector<std::size_t> left_out_;  ///< indices of animations with channels that are not played
    /// Keys that have been read, by indices of animation and sampler, number of components, and type of its output.
    std::map<std::tuple<std::size_t, std::size_t, std::size_t, std::string>, std::shared_ptr<const VectorKeys>>
        samplers_;
    std::map<const VectorKeys*, bool> changes_;  ///< results of changes()
};

}  // namespace

GltfTargetWeights read_gltf_animations(FileScene& scene, const GltfDocument& document, GltfAccessors& accessors,
                                       const std::vector<std::size_t>& file_indices, Checkpoint& checkpoint) {
    return AnimationReader(scene, document, accessors, file_indices, checkpoint).read();
}

}  // namespace realcam::io
