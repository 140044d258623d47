// Parts of a glTF file that become instanced objects. The truth is the numbers in the files.

#include <string>
#include <vector>

#include "gltf_files.hpp"
#include "refusal.hpp"
#include "scene/geometry/bounding_box.hpp"

using namespace scene_files;

namespace {

const std::string kLights = R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
    {"type":"point","intensity":7},{"type":"directional","intensity":9}]}})";

// A room with a table (0, 0, -3), turned about y so that its x is the room's -z, and on it a lamp with both lights.
const std::string kRoom = R"([{"name":"room","mesh":0,"children":[1]},
    {"name":"table","translation":[0,0,-3],"rotation":[0,0.70710678,0,0.70710678],"children":[2,3]},
    {"name":"top","mesh":1,"translation":[0,1,0]},
    {"name":"lamp","translation":[2,1,0],"children":[4,5]},
    {"name":"bulb","extensions":{"KHR_lights_punctual":{"light":0}}},
    {"name":"sun","extensions":{"KHR_lights_punctual":{"light":1}}}])";

Vec3d placed(const Instance& instance, Vec3d p) {
    return instance.scene_from_object.point(p);
}

std::string error_of_objects(const std::string& path, const std::vector<std::string>& names) {
    return test::message_of<Error>([&] { read_assembly(path, names); });
}

}  // namespace

TEST_CASE("glTF: a named node stands as an object, with all below it") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string path = folder.write("room.gltf", gltf(kRoom, "[0]", kLights));
    const Scene flat = read(path, 2.0);
    const Assembly scene = read_assembly(path, {"table"}, 2.0);
    REQUIRE(scene.instances.size() == 1);
    const Instance& table = scene.instances[0];
    CHECK(table.name == "table");
    CHECK(length(placed(table, {0, 0, 0}) - Vec3d{0, 0, -6}) < 1e-6);
    REQUIRE(scene.static_geometry->triangles.size() == 1);
    REQUIRE(table.object->triangles.size() == 1);
    REQUIRE(flat.triangles.size() == 2);
    for (int i = 0; i < 3; ++i) CHECK(length(placed(table, corner(*table.object, 0, i)) - corner(flat, 1, i)) < 1e-6);
    // The bulb goes with the lamp, the sun stays in the sky.
    REQUIRE(table.object->points.size() == 1);
    CHECK(length(placed(table, table.object->points[0].position_m) - flat.points[0].position_m) < 1e-6);
    CHECK(table.object->points[0].intensity == flat.points[0].intensity);
    CHECK(table.object->suns.empty());
    CHECK(scene.static_geometry->points.empty());
    REQUIRE(scene.static_geometry->suns.size() == 1);
    CHECK(length(static_cast<Vec3d>(scene.static_geometry->suns[0].direction - flat.suns[0].direction)) < 1e-6);
    const BoundingBox whole = bounding_box(scene), expected = bounding_box(Assembly(flat));
    CHECK(length(whole.low - expected.low) + length(whole.high - expected.high) < 1e-6);
}

TEST_CASE("glTF: nothing but objects, and one that is only a lamp") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string path = folder.write("room.gltf", gltf(kRoom, "[0]", kLights));
    const Assembly all = read_assembly(path, {"room"});
    CHECK(all.static_geometry->triangles.empty());
    REQUIRE(all.instances.size() == 1);
    CHECK(all.instances[0].object->triangles.size() == 2);
    const Assembly lamp = read_assembly(path, {"lamp"});
    CHECK(lamp.static_geometry->triangles.size() == 2);
    REQUIRE(lamp.instances.size() == 1);
    CHECK(lamp.instances[0].object->triangles.empty());
    CHECK(lamp.instances[0].object->points.size() == 1);
}

TEST_CASE("glTF: objects keep the materials and pictures that they use") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("a.png", "not decoded here");
    const std::string more = R"(,"materials":[{"name":"papered","pbrMetallicRoughness":{"metallicFactor":0,
        "baseColorTexture":{"index":0}}}],"textures":[{"source":0}],"images":[{"uri":"a.png"}])";
    const Assembly scene = read_assembly(folder.write("room.gltf", gltf(kRoom, "[0]", more + kLights)), {"table"});
    const Scene &ground = *scene.static_geometry, &table = *scene.instances[0].object;
    REQUIRE(ground.materials.size() == 1);
    CHECK(ground.textures.size() == 1);
    CHECK(ground.materials[0].diffuse_texture.texture == 0);
    REQUIRE(table.materials.size() == 1);  // that of a mesh without any
    CHECK(table.textures.empty());
    CHECK(table.materials[0].diffuse_texture.texture == -1);
}

TEST_CASE("glTF: a mesh that stands in very many places is shared") {
    const Folder folder;
    std::vector<std::uint16_t> indices;
    for (int i = 0; i < 1024; ++i) indices.insert(indices.end(), {0, 1, 2});
    folder.write("tri.bin", triangle_bytes(indices));
    std::string nodes = R"([{"mesh":1},{"mesh":0,"scale":[0,0,0]})", roots = "[0,1";
    for (int i = 0; i < 1024; ++i) {
        nodes += R"(,{"mesh":0,"translation":[)" + std::to_string(i) + ",0,0]}";
        roots += "," + std::to_string(i + 2);
    }
    const Assembly scene = read_assembly(
        folder.write("many.gltf", gltf(nodes + "]", roots + "]", "", R"(,"NORMAL":1,"TEXCOORD_0":2)", indices.size())),
        {});
    REQUIRE(scene.instances.size() == 1024);
    CHECK(scene.static_geometry->triangles.size() ==
          1024);  // of the other mesh; the node without size has no triangles
    CHECK(scene.instances[0].object == scene.instances[1023].object);
    CHECK(scene.instances[0].object->triangles.size() == 1024);
    CHECK(placed(scene.instances[1000], {0, 0, 0}).x == 1000);
    CHECK(scene.triangle_count() == 1025 * 1024);
}

TEST_CASE("glTF: what cannot be an object is said") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string path = folder.write("room.gltf", gltf(kRoom, "[0]", kLights));
    CHECK(has(error_of_objects(path, {"tabel"}), "has no node \"tabel\" (did you mean \"table\"?)"));
    CHECK(has(error_of_objects(path, {"sun"}), "node \"sun\" holds neither triangles nor a light"));
    const std::string flat = folder.write("flat.gltf", gltf(R"([{"name":"a","mesh":0,"scale":[1,0,1]}])", "[0]"));
    CHECK(has(error_of_objects(flat, {"a"}), "instance 0 (\"a\"): a transform must"));
    CHECK(has(error_of_objects(folder.write("a.ply", "ply\n"), {"a"}), "a .ply file has no nodes"));
}

TEST_CASE("glTF: nodes of one name become instances of distinct names") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string nodes = R"([{"name":"chair","mesh":0},{"name":"chair","mesh":0,"translation":[1,0,0]},
        {"name":"chair","mesh":0,"translation":[2,0,0]}])";
    const Assembly scene = read_assembly(folder.write("room.gltf", gltf(nodes, "[0,1,2]")), {"chair"});
    REQUIRE(scene.instances.size() == 3);
    CHECK(scene.instances[0].name == "chair");
    CHECK(scene.instances[1].name == "chair.2");
    CHECK(scene.instances[2].name == "chair.3");
    CHECK(scene.instances[2].scene_from_object.origin.x == 2.0);
}
