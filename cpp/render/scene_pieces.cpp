#include "scene_pieces.hpp"

namespace realcam {

ScenePieces::ScenePieces(const Assembly& assembly) : assembly_(assembly), every_(asks_every_triangle(assembly)) {
    ObjectBoxes objects;
    for (const Instance& instance : assembly.instances)
        if (!every_) boxes_.push_back(objects.of(instance));
}

std::size_t ScenePieces::count() const {
    return every_ ? assembly_.triangle_count()
                  : assembly_.static_geometry->triangles.size() + assembly_.instances.size();
}

}  // namespace realcam
