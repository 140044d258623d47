#include "scene_lights.hpp"

#include <string>

#include "../text/printable.hpp"

namespace realcam::io {
namespace {

Color color_of(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// A light emits along -z of its node, from its origin. The extension's `range` is not physical and ignored.
void add_light(Scene& scene, const FileLight& light, const Affine<double>& transform, const std::string& label,
               double scale) {
    if (light.type == "directional") {
        const Vec3d d = -transform.z;
        if (length(d) > 0) scene.suns.push_back({static_cast<Vec3f>(normalized(d)), color_of(light.strength)});
        return;
    }
    if (light.type == "point") {
        scene.points.push_back({scale * transform.origin, color_of(light.strength)});
    } else if (light.type == "spot") {
        const Vec3d axis = -transform.z;
        if (length(axis) > 0)
            scene.points.push_back({scale * transform.origin, color_of(light.strength), normalized(axis),
                                    light.inner_cone_angle, light.outer_cone_angle});
    } else {
        scene.warnings.push_back(label + ": point, directional or spot is wanted, not " + in_quotes(light.type));
    }
}

}  // namespace

void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out) {
    const FileScene& file = part.file;
    if (file.lights.empty()) return;
    visit_nodes(part, [&](std::uint32_t number, const Affine<double>& transform) {
        if (leaves_out(number, transform) == LeftOut::all) return false;
        const std::int32_t light = file.nodes[number].light;
        if (light >= 0)
            add_light(scene, file.lights[static_cast<std::size_t>(light)], transform,
                      file.path + ": light " + std::to_string(light), part.scale);
        return true;
    });
}

}  // namespace realcam::io
