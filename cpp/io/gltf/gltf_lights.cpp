#include "gltf_lights.hpp"

#include <algorithm>
#include <cmath>

namespace realcam::io {
namespace {

constexpr double kRightAngle = 1.57079632679489662;

/// True if two angles are equal up to rounding to float, so that angles just outside their range are accepted.
bool is_about(double a, double b) {
    return std::abs(a - b) < 1e-6;
}

/// Reads the cone of a spot light and clamps it to the allowed range. Returns false if it was outside.
bool read_cone(FileLight& light, const Json& spot) {
    const double outer = spot["outerConeAngle"].number(light.outer_cone_angle);
    const double inner = spot["innerConeAngle"].number(light.inner_cone_angle);
    light.outer_cone_angle = std::clamp(outer, 0.0, kRightAngle);
    light.inner_cone_angle = std::clamp(inner, 0.0, light.outer_cone_angle);
    return is_about(outer, light.outer_cone_angle) && is_about(inner, light.inner_cone_angle);
}

}  // namespace

void read_gltf_lights(FileScene& scene, const GltfDocument& document) {
    const Json& lights = document.root()["extensions"]["KHR_lights_punctual"]["lights"];
    std::size_t bad_cones = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double intensity = lights[i]["intensity"].number(1);
        const Json& colour = lights[i]["color"];
        FileLight light;
        light.type = lights[i]["type"].text();
        light.strength = {intensity * colour[std::size_t{0}].number(1), intensity * colour[1].number(1),
                          intensity * colour[2].number(1)};
        if (light.type == "spot" && !read_cone(light, lights[i]["spot"])) ++bad_cones;
        scene.lights.push_back(std::move(light));
    }
    if (bad_cones > 0)
        scene.warnings.push_back(std::to_string(bad_cones) +
                                 " spots have angles that are none; 0 <= innerConeAngle < outerConeAngle <= pi / 2 is "
                                 "wanted, and the nearest taken");
}

}  // namespace realcam::io
