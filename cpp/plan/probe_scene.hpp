#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../camera/models/pupil_sampling.hpp"
#include "../math/hypotenuse.hpp"
#include "../render/session/take_picture.hpp"
#include "plan.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

namespace probe_scene_detail {

/// Pixels of the longer side of the small picture.
inline constexpr int kLongSide = 48;

/// Number of lights, the brightest first, whose visibility is tested. Others count as visible.
inline constexpr std::size_t kTestedLights = 16;

/// Adds a light of the scene to the facts unless it is dark. `towards`: vector from the lens to it, in scene axes,
/// metres; for a sun, a direction. `lux`, `solid_angle_sr`: see VisibleLight.
inline void add_light(const InverseAffine<double>& camera_from_scene, Vec3d towards, double lux, double solid_angle_sr,
                      bool is_sun, SceneFacts& facts) {
    if (!(lux > 0)) return;
    const Vec3d from = normalized(camera_from_scene.direction(towards));
    facts.lights.push_back({from, lux, is_sun ? kInfinity : length(towards), solid_angle_sr});
}

/// Gives a pinhole camera a square film about the axis. Neither the directions of a calibration nor the curvature of
/// the lens's own film apply to it.
inline void set_square_film(Camera& camera, int side, double width_mm) {
    camera.film = {width_mm, width_mm, side, side};
    camera.geometry = nullptr;
    camera.lens.film_radius_of_curvature = kInfinity;
}

/// True if something occludes a light, by a picture of one pixel. `camera`: a pinhole camera, which is pointed at the
/// light; `settings`: with the layer depth_middle.
inline bool is_hidden(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                      const Affine<double>& scene_from_camera, const VisibleLight& light) {
    const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
    const double pupil_m = 0.001 * (camera.lens.film_position() - data.entrance_pupil_position);
    const Vec3d direction = scene_from_camera.direction(light.from);
    // Puts the pinhole at the entrance pupil of the lens.
    camera.pose.position_m = scene_from_camera.point({0, 0, -pupil_m}) - pupil_m * direction;
    camera.pose.look_at_m = camera.pose.position_m + direction;
    camera.pose.up = std::fabs(direction.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    camera.motion.clear();
    set_square_film(camera, 1, 1e-3);
    settings.spp = 1;
    const Image image = take_picture(session, scene, camera, settings, {});
    // Excludes the light's own surface, which extends towards the lens by its radius at most: distance times the square
    // root of solid angle / pi. 2 instead of 1 / sqrt(pi), 0.1% and 1 mm are margins.
    const double nearest = light.distance_m * (0.999 - 2 * std::sqrt(light.solid_angle_sr)) - 1e-3;
    return static_cast<double>(image.layers[0].values[0]) < pupil_m + nearest;
}

/// Sorts the lights by illuminance, the brightest first, and removes those that are hidden from the lens.
inline void remove_hidden_lights(Session& session, const Assembly& scene, const Camera& camera,
                                 const RenderSettings& settings, const Affine<double>& scene_from_camera,
                                 std::vector<VisibleLight>& lights) {
    std::sort(lights.begin(), lights.end(),
              [](const VisibleLight& a, const VisibleLight& b) { return a.illuminance_lux > b.illuminance_lux; });
    std::vector<VisibleLight> visible;
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (i >= kTestedLights || !is_hidden(session, scene, camera, settings, scene_from_camera, lights[i]))
            visible.push_back(lights[i]);
    lights = std::move(visible);
}

/// Luminance of a linear colour, in double precision.
inline double luminance_of(Color c) {
    return static_cast<double>(luminance(c));
}

/// Renders the view far beyond the frame, which ghosts may receive light from. `camera`, `settings`: those of the small
/// picture.
inline WideView wide_view(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                          const Progress& progress) {
    WideView view{.side = 16, .half_slope = 2, .values = {}};  // 63 degrees to each side
    const double f = std::fabs(first_order(camera.lens, camera.lens.wavelength_nm).effective_focal_length);
    set_square_film(camera, view.side, 2 * view.half_slope * f);
    settings.layers = {};
    const Image image = take_picture(session, scene, camera, settings, progress);
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
        const float* rgb = &image.exposure[3 * i];
        view.values.push_back(sensor_value(luminance_of({rgb[0], rgb[1], rgb[2]}), camera.iso));
    }
    return view;
}

/// Adds the point lights of an object, and one light for all triangles of each emissive material.
inline void add_lights_of_object(const Scene& object, const Affine<double>& scene_from_object, Vec3d lens_m,
                                 const InverseAffine<double>& camera_from_scene, SceneFacts& facts) {
    for (const ScenePointLight& point : object.points) {
        const Vec3d to_light = scene_from_object.point(point.position_m) - lens_m;
        add_light(camera_from_scene, to_light, luminance_of(point.intensity) / dot(to_light, to_light), 0, false,
                  facts);
    }
    struct EmissiveMaterial {
        double solid_angle = 0;
        Vec3d to_light = {0, 0, 0};  ///< integral of the vector from the lens over the solid angle
    };
    std::vector<EmissiveMaterial> emitters(object.materials.size());
    for (const Triangle& triangle : object.triangles) {
        if (!object.materials[triangle.material].emits()) continue;
        const auto corner = [&](int k) { return scene_from_object.point(object.positions_m[triangle.vertices[k]]); };
        const Vec3d a = corner(0), edges = cross(corner(1) - a, corner(2) - a);
        const Vec3d to_light = (1.0 / 3) * (a + corner(1) + corner(2)) - lens_m;
        const double distance = length(to_light), cosine_area = 0.5 * std::max(0.0, -dot(edges, to_light)) / distance;
        const double solid_angle = cosine_area / (distance * distance);
        emitters[triangle.material].solid_angle += solid_angle;
        emitters[triangle.material].to_light = emitters[triangle.material].to_light + solid_angle * to_light;
    }
    for (std::size_t m = 0; m < emitters.size(); ++m) {
        const double solid_angle = emitters[m].solid_angle;
        if (solid_angle > 0)
            add_light(camera_from_scene, (1 / solid_angle) * emitters[m].to_light,
                      luminance_of(object.materials[m].emission) * solid_angle, solid_angle, false, facts);
    }
}

}  // namespace probe_scene_detail

/// Probes a scene with a small picture through a pinhole: returns its tiles, the visible lights and the view beyond the
/// frame. `settings`: those of the picture that is planned. Throws the errors of take_picture, and NothingToPlan if the
/// camera sees neither an object nor any light.
inline SceneFacts probe_scene(Session& session, const Assembly& scene, Camera camera, RenderSettings settings,
                              const Progress& progress) {
    using namespace probe_scene_detail;
    const int columns = camera.film.width;
    camera.film = with_long_side(camera.film, kLongSide);
    const Film& film = camera.film;
    camera.model = CameraModel::pinhole;
    settings.spp = 8;  // enough for the mean of a tile
    settings.noise.reset();
    settings.effects = {};
    settings.pupil_sampling = PupilSampling::outline;
    settings.remove_spectra();
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
            motion = hypotenuse(static_cast<double>(at[0]), static_cast<double>(at[1])) * columns / film.width;
        }
        facts.tiles.push_back({1000 * depth - vertex_mm, value, motion});
        sees_anything |= std::isfinite(depth) || value > 0;
    }
    if (!sees_anything) throw NothingToPlan("there is nothing to plan: the camera sees no object and no light");
    const Affine<double> scene_from_camera =
        camera_detail::scene_from_camera(pose_at(camera, camera.exposure().begin_s));
    const InverseAffine<double> camera_from_scene = scene_from_camera.inverse();
    const Vec3d lens_m = scene_from_camera.point({0, 0, -0.001 * vertex_mm});
    add_lights_of_object(*scene.static_geometry, {}, lens_m, camera_from_scene, facts);
    for (const Instance& instance : scene.instances)
        add_lights_of_object(*instance.object, instance.transform_at(camera.exposure().begin_s), lens_m,
                             camera_from_scene, facts);
    for (const SunLight& sun : scene.static_geometry->suns)
        add_light(camera_from_scene, -static_cast<Vec3d>(sun.direction), luminance_of(sun.illuminance), 0, true, facts);
    for (VisibleLight& light : facts.lights) light.illuminance_lux *= settings.filter_transmittance();
    facts.surroundings = wide_view(session, scene, camera, settings, progress);
    settings.layers = {Layer::depth_middle};
    remove_hidden_lights(session, scene, camera, settings, scene_from_camera, facts.lights);
    return facts;
}

}  // namespace REALCAM_NAMESPACE
