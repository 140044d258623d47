#pragma once
#include <algorithm>
#include <cmath>

#include "../render/take_picture.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

namespace probe_scene_detail {

/// Pixels of the longer side.
inline constexpr double kLongSide = 48;

/// Adds a light of the scene; `towards`: from the lens, in scene axes, metres (any length of a sun's).
inline void add_light(const InverseAffine<double>& camera_from_scene, Vec3d towards, double lux, bool is_point,
                      SceneFacts& facts) {
    if (!(lux > 0)) return;
    const Vec3d from = normalized(camera_from_scene.direction(towards));
    facts.lights.push_back({from, lux, is_point});
}

inline double luminance_of(Color c) {
    return static_cast<double>(luminance(c));
}

/// Point lights and emissive triangles of one object. What stands between them and the camera is not looked at.
inline void add_lights_of(const Scene& object, const Affine<double>& scene_from_object, Vec3d lens_m,
                          const InverseAffine<double>& camera_from_scene, SceneFacts& facts) {
    for (const ScenePointLight& point : object.points) {
        const Vec3d way = scene_from_object.point(point.position_m) - lens_m;
        add_light(camera_from_scene, way, luminance_of(point.intensity) / dot(way, way), true, facts);
    }
    for (const Triangle& triangle : object.triangles) {
        const Material& material = object.materials[triangle.material];
        if (!material.emits()) continue;
        const auto corner = [&](int k) { return scene_from_object.point(object.positions_m[triangle.vertices[k]]); };
        const Vec3d a = corner(0), edges = cross(corner(1) - a, corner(2) - a);
        const Vec3d way = (1.0 / 3) * (a + corner(1) + corner(2)) - lens_m;
        const double distance2 = dot(way, way),
                     cosine_area = 0.5 * std::max(0.0, -dot(edges, way)) / std::sqrt(distance2);
        add_light(camera_from_scene, way, luminance_of(material.emission) * cosine_area / distance2, false, facts);
    }
}

}  // namespace probe_scene_detail

/// Looks at a scene with a small picture through a pinhole. `settings`: of the picture that is planned. Throws what
/// take_picture throws, and InputError where the camera sees neither an object nor any light.
inline SceneFacts probe_scene(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                              const Progress& progress) {
    using namespace probe_scene_detail;
    Film& film = camera.film;
    const double scale = std::min(1.0, kLongSide / std::max(film.width, film.height));
    const int columns = film.width;
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
    camera.model = CameraModel::pinhole;
    settings.spp = 8;
    settings.effects = {};
    settings.illuminant.reset();
    settings.layers = {Layer::depth_middle};
    const bool moves = scene.moves() || camera.moves();
    if (moves) settings.layers.add(Layer::motion);
    const Image image = take_picture(session, scene, camera, settings, progress);
    SceneFacts facts;
    facts.columns = image.width;
    facts.rows = image.height;
    const double vertex_mm = camera.lens.film_position();
    bool sees_anything = false;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        const auto channel = [&](std::size_t c) { return image.exposure[3 * i + c]; };
        const double value = sensor_value(luminance_of({channel(0), channel(1), channel(2)}), camera.iso);
        const auto depth = static_cast<double>(image.layers[0].values[i]);
        double motion = 0;
        if (moves) {
            const float* at = &image.layers[1].values[2 * i];
            motion = std::hypot(static_cast<double>(at[0]), static_cast<double>(at[1])) * columns / film.width;
        }
        facts.tiles.push_back({1000 * depth - vertex_mm, value, motion});
        sees_anything |= std::isfinite(depth) || value > 0;
    }
    if (!sees_anything) throw InputError("there is nothing to plan: the camera sees no object and no light");
    const Affine<double> scene_from_camera =
        camera_detail::scene_from_camera(pose_at(camera, camera.exposure().begin_s));
    const InverseAffine<double> camera_from_scene = scene_from_camera.inverse();
    const Vec3d lens_m = scene_from_camera.point({0, 0, -0.001 * vertex_mm});
    add_lights_of(*scene.static_geometry, {}, lens_m, camera_from_scene, facts);
    for (const Instance& instance : scene.instances)
        add_lights_of(*instance.object, instance.transform_at(camera.exposure().begin_s), lens_m, camera_from_scene,
                      facts);
    for (const SunLight& sun : scene.static_geometry->suns)
        add_light(camera_from_scene, -static_cast<Vec3d>(sun.direction), luminance_of(sun.illuminance), true, facts);
    return facts;
}

}  // namespace REALCAM_NAMESPACE
