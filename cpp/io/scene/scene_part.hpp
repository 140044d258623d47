#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "../../checkpoint.hpp"
#include "file_scene.hpp"

namespace realcam::io {

/// Nodes `first` to `end` - 1 of a file. `transform`, if present, replaces the transforms of nodes whose parents are
/// not among them. The file and the checkpoint have to outlive it.
struct ScenePart {
    const FileScene& file;
    double scale;  ///< metres per unit of the file
    std::uint32_t first, end;
    std::optional<Affine<double>> transform;
    Checkpoint& checkpoint;
};

/// Part of a node that is left out: nothing, its meshes, or the node with all its descendants.
enum class LeftOut { nothing, meshes, all };
using LeavesOut = std::function<LeftOut(std::uint32_t node, const Affine<double>& transform)>;

/// Calls `visit(node, transform)` for the nodes of a part, from the top; if it returns false, the descendants are
/// skipped.
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
