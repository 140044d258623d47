#include "scene_lights.hpp"

#include "affine.hpp"

namespace realcam::io {
namespace {

// A light shines along -z of its node, from its origin. The extension's `range` is no physics, and left out.
void add_light(Scene& scene, const Json& light, const Affine<double>& transform, const std::string& label,
               double scale) {
    const double intensity = light["intensity"].number(1);
    const Json& colour = light["color"];
    const Vec3d strength = {intensity * colour[std::size_t{0}].number(1), intensity * colour[1].number(1),
                            intensity * colour[2].number(1)};
    const std::string type = light["type"].text();
    if (type == "directional") {
        const Vec3d d = -transform.z;
        if (length(d) > 0) {
            scene.suns.push_back({static_cast<Vec3f>(normalized(d)), static_cast<Vec3f>(strength)});
        }
        return;
    }
    if (type == "spot") scene.warnings.push_back(label + " is a spot; it shines in all directions here");
    if (type == "point" || type == "spot") {
        scene.points.push_back({scale * transform.origin, static_cast<Vec3f>(strength)});
    } else {
        scene.warnings.push_back(label + ": point, directional or spot is wanted, not \"" + type + "\"");
    }
}

}  // namespace

void read_lights(Scene& scene, const ScenePart& part, const LeavesOut& leaves_out) {
    const GltfDocument* gltf = part.file.gltf();
    if (!gltf) return;
    const Json& lights = gltf->root()["extensions"]["KHR_lights_punctual"]["lights"];
    const auto visit = [&](const auto& self, const aiNode& node, const Affine<double>& transform) -> void {
        if (leaves_out(node, transform) == LeftOut::all) return;
        const Json& number = gltf->node(node)["extensions"]["KHR_lights_punctual"]["light"];
        if (number.is_number()) {
            const std::size_t i = number.index(lights.size());
            add_light(scene, lights[i], transform, part.path + ": light " + std::to_string(i), part.scale);
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) {
            const aiNode& child = *node.mChildren[i];
            self(self, child, transform * gltf->transform(child));
        }
    };
    visit(visit, part.node, part.transform);
}

}  // namespace realcam::io
