#include <limits>
#include <memory>
#include <string>

#include "bare_scene.hpp"
#include "doctest/doctest.h"
#include "refusal.hpp"
#include "scene/scene_checks.hpp"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("validate: a scene from arrays") {
    Scene good;
    good.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    good.triangles = {{{0, 1, 2}, 0}};
    good.materials = {Material{}};
    CHECK_NOTHROW(validate(good));
    CHECK_THROWS_AS(validate(Scene{}), SceneFileError);

    const auto message = [&](auto change) {
        Scene scene = good;
        change(scene);
        return message_of([&] { validate(scene); });
    };
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(contains(message([](Scene& s) { s.positions_m[1].y = double(nan); }), "vertex 1: coordinates"));
    CHECK(contains(message([](Scene& s) { s.positions_m[2].y = 1e300; }), "vertex 2: coordinates"));
    CHECK(contains(message([](Scene& s) { s.triangles[0].vertices[2] = 3; }),
                   "triangle 0: vertex 3 does not exist; there are 3"));
    CHECK(contains(message([](Scene& s) { s.triangles[0].material = 1; }), "triangle 0: material 1 does not exist"));
    CHECK(contains(message([](Scene& s) { s.normals.resize(2); }), "2 normals for 3 vertices"));
    CHECK(contains(message([](Scene& s) { s.uvs.resize(4); }), "4 texture coordinates for 3 vertices"));
    CHECK(contains(message([](Scene& s) { s.normals.assign(3, {0, nan, 0}); }), "normal 0"));
    CHECK(contains(message([](Scene& s) { s.materials[0].diffuse.r = -1; }), "material 0: diffuse"));
    CHECK(contains(message([](Scene& s) { s.materials[0].specular.r = nan; }), "material 0: specular"));
    CHECK(contains(message([](Scene& s) { s.materials[0].emission.b = -1; }), "material 0: emission"));
    CHECK(contains(message([](Scene& s) { s.materials[0].diffuse_texture.texture = 0; }), "texture 0 does not exist"));
    CHECK(contains(message([](Scene& s) { s.textures = {{"t", 2, 2, {1, 2, 3}, {}, TextureEncoding::srgb}}; }),
                   "must hold width x height x 4 numbers"));
    CHECK(contains(message([](Scene& s) { s.points = {{{0, 0, 0}, {-1, 0, 0}}}; }), "point light 0"));
    CHECK(contains(message([](Scene& s) { s.suns = {{{0, 0, 0}, {1, 1, 1}}}; }), "sun 0: its direction"));
    CHECK(contains(message([](Scene& s) { s.environment.constant.g = nan; }), "environment"));
    CHECK(contains(message([](Scene& s) { s.environment.pixels.resize(3); }), "environment: expected width x height"));

    // The ends of the range, at which pictures are still finite.
    CHECK(contains(message([](Scene& s) { s.positions_m[0].z = -1.1e12; }), "at most 1e12 m"));
    CHECK(contains(message([](Scene& s) { s.materials[0].emission.r = 1.1e20f; }), "between 0 and 1e20 cd/m^2"));
    CHECK(contains(message([](Scene& s) { s.materials[0].shininess = 1.1e9f; }), "between 0 and 1e9"));
    CHECK(contains(message([](Scene& s) { s.points = {{{0, 0, 0}, {1, 2e30f, 1}}}; }), "between 0 and 1e30 cd"));
    CHECK(contains(message([](Scene& s) { s.suns = {{{0, -1, 0}, {1, 2e20f, 1}}}; }), "between 0 and 1e20 lux"));
    CHECK(
        contains(message([](Scene& s) { s.positions_m[0].z = -1e12, s.materials[0].shininess = 1e9f; }), "(no error)"));

    Scene thin = good;
    thin.triangles.push_back({{0, 1, 1}, 0});
    CHECK(drop_degenerate_triangles(thin) == 1);
    CHECK(thin.triangles.size() == 1);
}

TEST_CASE("SceneChecks: what was checked with the last scene is not checked again") {
    // Behind the backs of the assemblies, which hold them as const: nobody else can tell what was looked at.
    const auto floor = std::make_shared<Scene>(bare_scene()), chair = std::make_shared<Scene>(bare_scene());
    Assembly room(floor);
    room.instances.push_back({chair, {}, "chair"});
    SceneChecks checks;
    CHECK_NOTHROW(checks.check(room));
    floor->triangles[0].vertices[1] = 7;
    chair->positions_m[2].x = std::numeric_limits<double>::infinity();

    CHECK_NOTHROW(checks.check(room));
    room.instances[0].scene_from_object.origin = {1, 2, 3};
    CHECK_NOTHROW(checks.check(room));
    room.instances.push_back(room.instances[0]);
    CHECK_NOTHROW(checks.check(room));
    CHECK_THROWS_WITH_AS(SceneChecks().check(room), "scene: triangle 0: vertex 7 does not exist; there are 3",
                         InputError);

    // A transform is looked at whenever it is another one, and a part that was not there.
    Assembly flat = room;
    flat.instances[1].scene_from_object.x = {0, 0, 0};
    CHECK_THROWS_WITH_AS(
        checks.check(flat),
        "instance 1 (\"chair\"): a transform must keep three directions; this one makes the object flat", InputError);
    Assembly other = room;
    other.instances.push_back({std::make_shared<Scene>(*chair), {}, "table"});
    CHECK_THROWS_WITH_AS(checks.check(other), "scene: vertex 2: coordinates must be finite numbers of at most 1e12 m",
                         InputError);
    other.instances.back().object = nullptr;
    CHECK_THROWS_WITH_AS(checks.check(other), "instance 2 (\"table\") has no object", InputError);
    CHECK_THROWS_WITH_AS(checks.check(Assembly()), "the scene is empty; expected at least one triangle", InputError);
    CHECK_NOTHROW(checks.check(room));
}

TEST_CASE("SceneChecks: an object without a triangle is not a scene") {
    Scene lamp;
    lamp.points = {{{0, 0, 0}, {1, 1, 1}}};
    const auto shared = std::make_shared<const Scene>(lamp);
    Assembly room(bare_scene());
    room.instances.push_back({shared, {}, "lamp"});
    SceneChecks checks;
    CHECK_NOTHROW(checks.check(room));
    CHECK_THROWS_AS(checks.check(Assembly(shared)), SceneFileError);
}
