#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "../../checkpoint.hpp"
#include "file_scene.hpp"

namespace realcam::io {

/// Part of a file: nodes `first` to `end` - 1. `transform`, if present, replaces the transforms of the nodes whose
/// parents are not in the part. The file and the checkpoint must outlive it.
struct ScenePart {
    const FileScene& file;
    double scale;  ///< metres per unit of the file
    std::uint32_t first, end;
    std::optional<Affine<double>> transform;
    Checkpoint& checkpoint;
};

/// Part of a node that is left out: nothing, its meshes, or the node with all its descendants.
enum class LeftOut { nothing, meshes, all };
/// Function that decides what of a node is left out. `transform`: from the node to the scene, in units of the file.
using LeftOutFunction = std::function<LeftOut(std::uint32_t node, const Affine<double>& transform)>;

/// Calls `visit(node, transform)` for the nodes of a part, parents before children; if it returns false, the
/// descendants are skipped. `node`: index; `transform`: from the node to the scene, in units of the file.
template <class Visit>
void visit_nodes(const ScenePart& part, Visit&& visit) {
    std::vector<Affine<double>> transforms(part.end - part.first);
    for (std::uint32_t i = part.first; i < part.end;) {
        part.checkpoint.pass();
        const FileNode& node = part.file.nodes[i];
        const bool is_top = node.parent == kNoParent || node.parent < part.first;
        Affine<double>& transform = transforms[i - part.first];
        transform = is_top ? part.transform.value_or(node.parent_from_node)
                           : transforms[node.parent - part.first] * node.parent_from_node;
        i = visit(i, transform) ? i + 1 : node.end;
    }
}

}  // namespace realcam::io
