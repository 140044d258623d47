// Default subject of a picture, for scenes in which the subject is not the whole bounding box.

#include <string>
#include <vector>

#include "../set_pieces.hpp"
#include "camera/film/camera.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "render/framing/default_view.hpp"
#include "render/framing/first_hit.hpp"
#include "render/framing/subject.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr Extent kObject = {{4, 0, -6}, {4.3, 0.3, -5.7}};

void check_subject(const Assembly& scene, const Extent& wanted) {
    const BoundingBox box = Subject(scene, {0, 1, 0}).box;
    const double leave = 1e-9 * length(wanted.high - wanted.low);
    CHECK(length(box.low - wanted.low) <= leave);
    CHECK(length(box.high - wanted.high) <= leave);
}

void check_whole(const Scene& scene) {
    const BoundingBox box = bounding_box(Assembly(scene));
    check_subject(Assembly(scene), {box.low, box.high});
}

Camera framed(const Assembly& scene, const Vec3d& up = {0, 1, 0}) {
    Camera camera;
    camera.lens = io::read_lens("double-gauss-50mm");
    camera.film = default_film(camera.lens, {}, {});
    ViewRequest request;
    request.up = up;
    set_view(camera, scene, request);
    return camera;
}

/// z of the entrance pupil, from where the camera sees.
double eye_z(const Camera& camera) {
    const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
    return camera.pose.position_m.z - (camera.lens.film_position() - data.entrance_pupil_position) / 1000;
}

void add_table(Scene& scene) {
    add_box(scene, {{-1, 0.7, -0.5}, {1, 0.75, 0.5}});
    for (const double x : {-0.9, 0.85})
        for (const double z : {-0.4, 0.35}) add_box(scene, {{x, 0, z}, {x + 0.05, 0.7, z + 0.05}});
}

Scene object() {
    Scene scene = grey_scene();
    add_box(scene, kObject);
    return scene;
}

}  // namespace

TEST_CASE("an object of 0.3 m on a floor of 30 m is the subject, however the floor is made") {
    Scene plain = object(), tiled = object(), slab = object(), hilltop = object();
    add_patch(plain, {-15, 0, -15}, {0, 0, 30}, {30, 0, 0});
    add_patch(tiled, {-15, 0, -15}, {0, 0, 30}, {30, 0, 0}, 150);
    add_box(slab, {{-15, -0.1, -15}, {15, 0, 15}});
    for (const Scene& scene : {plain, tiled, slab}) check_subject(Assembly(scene), kObject);
    // A backdrop and side walls, as on a stage.
    add_patch(tiled, {-15, 0, -15}, {30, 0, 0}, {0, 12, 0}, 40);
    add_patch(tiled, {-15, 0, -15}, {0, 12, 0}, {0, 0, 30}, 40);
    check_subject(Assembly(tiled), kObject);

    const Camera camera = framed(Assembly(plain));
    CHECK(length(camera.pose.look_at_m - Vec3d{4.15, 0.15, -5.85}) < 1e-9);
    // It fills nine tenths of the picture's height, 24 mm at 50 mm: 0.3 m from 0.3 * 50.36 / (0.9 * 24) = 0.7 m, less
    // the narrowing of the field at close distance, in front of its near side. From the side it is wider.
    CHECK(eye_z(camera) > -5.7 + 0.6);
    CHECK(eye_z(camera) < -5.7 + 0.9);
}

TEST_CASE("floors and objects may be instances") {
    const auto floor = std::make_shared<Scene>(grey_scene());
    add_patch(*floor, {-0.5, 0, -0.5}, {0, 0, 1}, {1, 0, 0});
    const auto cube = std::make_shared<Scene>(grey_scene());
    add_box(*cube, {{0, 0, 0}, {1, 1, 1}});
    Assembly scene{Scene{}};
    scene.instances.push_back({floor, {{30, 0, 0}, {0, 1, 0}, {0, 0, 30}, {0, 0, 0}}, "floor"});
    scene.instances.push_back({cube, {{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}, kObject.low}, "cube"});
    check_subject(scene, kObject);
}

TEST_CASE("what stands on a table is the subject, wherever the table stands") {
    const Extent cup = {{0.3, 0.75, 0.1}, {0.4, 0.85, 0.2}};
    Scene table = grey_scene();
    add_table(table);
    add_box(table, cup);
    Scene on_floor = table, in_room = table, with_lamp = table, furnished = table;
    add_patch(on_floor, {-15, 0, -15}, {0, 0, 30}, {30, 0, 0});
    const Extent walls = {{-3, 0, -3}, {3, 2.6, 3}};
    for (Scene* scene : {&in_room, &with_lamp, &furnished}) add_box(*scene, walls, true);
    with_lamp.materials.resize(2);
    with_lamp.materials[1].emission = {1, 1, 1};
    add_box(with_lamp, {{-0.9, 1.5, -0.4}, {0.9, 1.6, 0.4}});
    for (std::size_t i = with_lamp.triangles.size() - 12; i < with_lamp.triangles.size(); ++i)
        with_lamp.triangles[i].material = 1;
    for (const Scene& scene : {table, on_floor, in_room, with_lamp}) check_subject(Assembly(scene), cup);
    // Beside other furniture it is not.
    add_box(furnished, {{-2.9, 0, -2.9}, {-2, 2, -2}});
    check_whole(furnished);
}

TEST_CASE("a picture on a wall is the subject") {
    Scene scene = grey_scene();
    add_patch(scene, {-4, 0, 0}, {8, 0, 0}, {0, 3, 0});
    add_patch(scene, {-0.4, 1.3, 0.02}, {0.8, 0, 0}, {0, 0.6, 0});
    check_subject(Assembly(scene), {{-0.4, 1.3, 0.02}, {0.4, 1.9, 0.02}});
}

TEST_CASE("a sky around an object is not the subject") {
    for (const double radius : {20.0, 1000.0}) {
        CAPTURE(radius);
        Scene sphere = object(), dome = object(), box = object();
        add_sphere(sphere, {0, 0, 0}, radius, 24);
        add_sphere(dome, {0, -1, 0}, radius, 24, 0);
        add_box(box, {{-radius, -radius, -radius}, {radius, radius, radius}}, true);
        for (const Scene& sky : {sphere, dome, box}) check_subject(Assembly(sky), kObject);
        add_patch(dome, {-radius, 0, -radius}, {0, 0, 2 * radius}, {2 * radius, 0, 0}, 100);
        check_subject(Assembly(dome), kObject);
    }
    // With a floor of its own beneath the object.
    Scene set = object();
    add_sphere(set, {0, 0, 0}, 500, 24);
    add_patch(set, {-15, 0, -15}, {0, 0, 30}, {30, 0, 0}, 60);
    check_subject(Assembly(set), kObject);
}

TEST_CASE("what is far away and little is not the subject") {
    Scene scene = grey_scene();
    add_sphere(scene, {0, 1, 0}, 1, 12);
    const BoundingBox ball = bounding_box(Assembly(scene));
    add_box(scene, {{5e4, 0, 0}, {5e4 + 0.1, 0.1, 0.1}});
    check_subject(Assembly(scene), {ball.low, ball.high});
    // Two equal balls are both the subject.
    Scene two = grey_scene();
    add_sphere(two, {0, 1, 0}, 1, 12);
    add_sphere(two, {5e4, 1, 0}, 1, 12);
    check_whole(two);
}

TEST_CASE("ordinary objects are the subject as a whole") {
    Scene cube = object(), ball = grey_scene(), table = grey_scene(), stage = grey_scene(), globe = grey_scene();
    add_sphere(ball, {0, 0, 0}, 2, 16);
    add_table(table);
    // Three balls, spread over the table.
    for (const double x : {-0.7, 0.0, 0.7}) add_sphere(table, {x, 0.85, 0.1}, 0.1, 8);
    // A pedestal under a statue: its base is three times as wide.
    add_box(stage, {{-3, 0, -3}, {3, 0.2, 3}});
    add_box(stage, {{-1, 0.2, -1}, {1, 3, 1}});
    // A small ball in a glass one.
    add_sphere(globe, {0, 0, 0}, 0.3, 16);
    add_sphere(globe, {0, 0, 0}, 1, 16);
    for (const Scene& scene : {cube, ball, table, stage, globe}) check_whole(scene);
    Scene flat = grey_scene();
    add_patch(flat, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 5);
    check_whole(flat);
}

namespace {

/// Image position of a point, from -1 to 1 over the film's width and height, by the ideal image of the lens's focal
/// length; z: distance in front of the entrance pupil, m.
Vec3d seen_at(const Camera& camera, Vec3d point_m) {
    const auto axes = camera_detail::axes_of(camera.pose);
    const FirstOrder data = first_order(camera.lens, camera.lens.wavelength_nm);
    const double film_to_pupil_m = (camera.lens.film_position() - data.entrance_pupil_position) / 1000;
    const Vec3d from = point_m - (camera.pose.position_m - film_to_pupil_m * axes.backward);
    const double depth = -dot(from, axes.backward), scale = 2 * data.effective_focal_length / depth;
    return {scale * dot(from, axes.right) / camera.film.width_mm, scale * dot(from, axes.up) / camera.film.height_mm,
            depth};
}

/// A room of 4 x 2.6 x 6 m with three pieces of furniture.
constexpr Extent kRoomWalls = {{-2, 0, -3}, {2, 2.6, 3}};
void furnish(Scene& scene) {
    add_box(scene, {{-1.5, 0, -2.5}, {-0.5, 1, -1.5}});
    add_box(scene, {{0.4, 0, -2}, {1.6, 0.8, 0}});
    add_box(scene, {{-1.9, 0, 1}, {-1.4, 2, 2.5}});
}

}  // namespace

TEST_CASE("a closed room is seen from a corner that shows its content") {
    Scene room = grey_scene(), lit = grey_scene();
    add_box(room, kRoomWalls, true);
    add_box(lit, kRoomWalls);
    lit.points.push_back({{0, 2.4, 0}, {100, 100, 100}});
    for (Scene* scene : {&room, &lit}) furnish(*scene);
    check_whole(room);
    // The same room with z up: its coordinates are rotated about x.
    Scene turned = room;
    for (Vec3d& p : turned.positions_m) p = {p.x, -p.z, p.y};
    for (const bool z_is_up : {false, true})
        for (const Scene& scene : {z_is_up ? turned : room, lit}) {
            if (z_is_up && &scene == &lit) continue;
            const Camera camera = framed(Assembly(scene), z_is_up ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0});
            const Vec3d p = camera.pose.position_m;
            const Vec3d at = z_is_up && !scene.points.size() ? Vec3d{p.x, p.z, -p.y} : p;
            CHECK(std::fabs(at.x) < 2);
            CHECK(std::fabs(at.z) < 3);
            CHECK(at.y > 1.3);
            CHECK(at.y < 2.6);
        }
    for (const Scene& scene : {room, lit}) {
        const Camera camera = framed(Assembly(scene));
        // The box in the far corner is in the picture, and nothing hides the view for most of the way to it.
        const Vec3d box = seen_at(camera, {-1, 0.5, -2});
        CHECK(std::fabs(box.x) < 1);
        CHECK(std::fabs(box.y) < 1);
        CHECK(camera.lens.focus_distance / 1000 > 1.5);
    }
}

TEST_CASE("an empty room is seen from one corner to the opposite one") {
    Scene room = grey_scene();
    add_box(room, kRoomWalls, true);
    const Camera camera = framed(Assembly(room));
    CHECK(length(camera.pose.look_at_m - Vec3d{0, 1.3, 0}) < 1e-9);
    CHECK(camera.pose.position_m.x * camera.pose.position_m.z != 0);
}

TEST_CASE("an open room fills the picture from its open side, whichever that is") {
    Scene open = grey_scene();
    add_box(open, kRoomWalls, true, true);
    furnish(open);
    for (const int quarter : {0, 1, 2, 3}) {
        CAPTURE(quarter);
        Scene scene = open;
        for (Vec3d& p : scene.positions_m)
            for (int i = 0; i < quarter; ++i) p = {p.z, p.y, -p.x};
        const Camera camera = framed(Assembly(scene));
        const auto to_opening = [&](Vec3d p) {
            for (int i = 0; i < quarter; ++i) p = {p.z, p.y, -p.x};
            return seen_at(camera, p);
        };
        // 4 m by 2.6 m at 36 by 24: the width is cut by the film's edge, by 3% of distortion at most the height, too.
        const Vec3d corner = to_opening({2, 2.6, 3});
        CHECK(corner.z > 1);
        CHECK(std::fabs(corner.x) > 1);
        CHECK(std::fabs(corner.x) < 1.1);
        CHECK(std::fabs(corner.y) == doctest::Approx(1).epsilon(0.03));
    }
}

TEST_CASE("an object is seen from slightly above and aside, and no side of it edge on") {
    Scene crate = grey_scene(), floor = grey_scene(), poster = grey_scene();
    add_box(crate, {{-1, 0, -1}, {1, 2, 1}});
    add_patch(floor, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    add_patch(poster, {-1, 0, 0}, {2, 0, 0}, {0, 1, 0});
    const auto check_view = [](const Scene& scene, double elevation_deg, double azimuth_deg) {
        const Pose pose = framed(Assembly(scene)).pose;
        const Vec3d view = pose.position_m - pose.look_at_m;
        CHECK(view.z > 0);
        CHECK(std::atan2(view.y, std::hypot(view.x, view.z)) * 180 / std::numbers::pi ==
              doctest::Approx(elevation_deg));
        CHECK(std::atan2(view.x, view.z) * 180 / std::numbers::pi == doctest::Approx(azimuth_deg));
    };
    check_view(crate, 22.5, 22.5);  // half of 45 degrees
    check_view(floor, 45, 22.5);  // half of 90
    check_view(poster, 0, 0);
    for (const Scene& scene : {crate, floor, poster}) {
        const Camera camera = framed(Assembly(scene));
        const BoundingBox box = bounding_box(Assembly(scene));
        double farthest = 0;
        for (int i = 0; i < 8; ++i) {
            const Vec3d corner = seen_at(camera, box.corner(i));
            farthest = std::max({farthest, std::fabs(corner.x), std::fabs(corner.y)});
        }
        CHECK(farthest == doctest::Approx(0.9).epsilon(0.03));  // the lens's distortion
    }
}

TEST_CASE("no wall is between the camera and its subject") {
    // A hall with one chair in its middle, near the wall behind the camera.
    Scene hall = grey_scene();
    add_box(hall, {{-10, 0, -19}, {10, 6, 1.2}});
    add_box(hall, {{-0.5, 0, -0.5}, {0.5, 1, 0.5}});
    check_subject(Assembly(hall), {{-0.5, 0, -0.5}, {0.5, 1, 0.5}});
    const Camera camera = framed(Assembly(hall));
    CHECK(eye_z(camera) < 1.2);
    CHECK(eye_z(camera) > 1.1);
}

TEST_CASE("many instances are framed by the boxes of their objects") {
    const auto ball = std::make_shared<Scene>(grey_scene());
    add_sphere(*ball, {0, 0, 0}, 1, 40);
    Assembly scene{Scene{}};
    const std::size_t count = kMaxTrianglesTested / ball->triangles.size() + 10;
    for (std::size_t i = 0; i < count; ++i)
        scene.instances.push_back(
            {ball, Affine<double>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3.0 * static_cast<double>(i), 0, 0}}, ""});
    REQUIRE(!has_exact_boxes(scene));
    const double last = 3.0 * static_cast<double>(count - 1);
    check_subject(scene, {{-1, -1, -1}, {last + 1, 1, 1}});
    CHECK(first_hit(scene, {9, 0, 50}, {0, 0, -1}) == doctest::Approx(49));
    CHECK(first_hit(scene, {9, 0, 50}, {0, 0, -1}, 49.5) == doctest::Approx(51));
    CHECK(std::isinf(first_hit(scene, {9, 0, 50}, {0, 0, -1}, 51.5)));
    CHECK(std::isinf(first_hit(scene, {10.5, 0, 50}, {0, 0, -1})));
}
