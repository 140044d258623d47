#include "scene.hpp"

namespace realcam {

bool Scene::has_local_light() const {
    if (!points.empty()) return true;
    for (const Triangle& t : triangles)
        if (materials[t.material].emits()) return true;
    return false;
}

}  // namespace realcam
