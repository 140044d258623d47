// EXT_mesh_gpu_instancing, the cameras of a glTF, and messages about unsupported extensions.

#include <cmath>
#include <cstring>
#include <string>

#include "camera/film/camera.hpp"
#include "camera/models/pinhole_camera.hpp"
#include "gltf_files.hpp"
#include "io/lens/lens_file.hpp"
#include "render/framing/default_view.hpp"

namespace {

using namespace scene_files;

/// glTF with accessors 4 to 6: translations, rotations and scales of `count` instances.
std::string instanced(const Folder& folder, const std::string& attributes, const std::vector<float>& translations,
                      const std::vector<float>& rotations, const std::vector<float>& scales, std::size_t count,
                      const std::string& node = R"("translation":[10,0,0],)") {
    std::string bytes;
    for (const std::vector<float>* list : {&translations, &rotations, &scales})
        bytes.append(reinterpret_cast<const char*>(list->data()), sizeof(float) * list->size());
    folder.write("tri.bin", triangle_bytes());
    bytes.resize(40 * count);
    folder.write("places.bin", bytes);
    const std::string n = std::to_string(count), t = std::to_string(12 * count), r = std::to_string(16 * count);
    std::string text = gltf("[{" + node + R"("mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" +
                                attributes + R"(}}},"children":[1]},{"name":"below","mesh":1,"translation":[0,0,5]}])",
                            "[0]", R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])");
    const auto insert = [&](const std::string& list, const std::string& item) {
        text.insert(text.find(']', text.find('"' + list + "\":[")), "," + item);
    };
    insert("accessors", R"({"bufferView":4,"componentType":5126,"count":)" + n + R"(,"type":"VEC3"},{"bufferView":5,
        "componentType":5126,"count":)" +
                            n + R"(,"type":"VEC4"},{"bufferView":6,"componentType":5126,"count":)" + n +
                            R"(,"type":"VEC3"})");
    insert("bufferViews", R"({"buffer":1,"byteLength":)" + t + R"(},{"buffer":1,"byteOffset":)" + t +
                              R"(,"byteLength":)" + r + R"(},{"buffer":1,"byteOffset":)" + std::to_string(28 * count) +
                              R"(,"byteLength":)" + t + "}");
    insert("buffers", R"({"byteLength":)" + std::to_string(40 * count) + R"(,"uri":"places.bin"})");
    return folder.write("i.gltf", text);
}

std::string with_cameras(const Folder& folder, const std::string& nodes, const std::string& roots,
                         const std::string& cameras) {
    folder.write("tri.bin", triangle_bytes());
    return folder.write("c.gltf", gltf(nodes, roots, R"(,"cameras":)" + cameras));
}

void check_point(Vec3d p, double x, double y, double z, double within = 1e-9) {
    CHECK(std::abs(p.x - x) < within);
    CHECK(std::abs(p.y - y) < within);
    CHECK(std::abs(p.z - z) < within);
}

}  // namespace

TEST_CASE("glTF: a node has its mesh as often as EXT_mesh_gpu_instancing says, each moved, turned and scaled") {
    const Folder folder;
    const float half = static_cast<float>(std::sqrt(0.5));
    const Scene scene = read(instanced(folder, R"("TRANSLATION":4,"ROTATION":5,"SCALE":6)", {1, 0, 0, 0, 2, 0},
                                       {0, 0, 0, 1, 0, 0, half, half}, {1, 1, 1, 3, 1, 1}, 2));
    CHECK(scene.warnings.empty());
    REQUIRE(scene.triangles.size() == 3);  // two instances, and the child once
    check_point(corner(scene, 0, 1), 12, 0, 0);
    // (1, 0, 0) is stretched by 3, turned about z by a right angle, and moved.
    check_point(corner(scene, 1, 1), 10, 5, 0, 1e-6);
    check_point(corner(scene, 1, 2), 9, 2, 0, 1e-6);
    check_point(corner(scene, 2, 0), 10, 0, 5);

    const Scene moved = read(instanced(folder, R"("TRANSLATION":4)", {1, 0, 0, 0, 2, 0}, {}, {}, 2));
    check_point(corner(moved, 1, 0), 10, 2, 0);
    CHECK(has(error_of(instanced(folder, R"("TRANSLATION":4,"SCALE":0)", {1, 0, 0, 0, 2, 0}, {}, {}, 2)),
              "expected one for each"));
    CHECK(has(error_of(instanced(folder, R"("TRANSLATION":99)", {}, {}, {}, 2)), "there are 7"));
    // Below a node that becomes an object they move with it.
    const Assembly object = read_assembly(
        instanced(folder, R"("TRANSLATION":4)", {1, 0, 0, 0, 2, 0}, {}, {}, 2, R"("name":"all",)"), {"all"});
    REQUIRE(object.instances.size() == 1);
    CHECK(object.instances[0].object->triangles.size() == 3);
}

TEST_CASE("glTF: a million triangles of instances are shared") {
    const Folder folder;
    const std::size_t count = (1 << 20) + 2;
    std::vector<float> translations(3 * count);
    for (std::size_t i = 0; i < count; ++i) translations[3 * i] = static_cast<float>(i);
    const Assembly scene = read_assembly(instanced(folder, R"("TRANSLATION":4)", translations, {}, {}, count), {});
    CHECK(scene.instances.size() == count);
    CHECK(scene.instances.back().object->triangles.size() == 1);
    CHECK(scene.instances.back().scene_from_object.origin.x == 10.0 + double(count - 1));
}

TEST_CASE("glTF: cameras stand where their nodes do, and the first is the view where nobody says another") {
    const Folder folder;
    const std::string
        perspective = R"({"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}})",
        flat = R"({"name":"plan","type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":1}})";
    // Turned about y by a right angle, it looks along -x; inside a node that is moved.
    const std::string nodes = R"([{"mesh":0},{"name":"rig","translation":[5,1,0],"children":[2]},
        {"name":"side","camera":1,"rotation":[0,0.7071067811865476,0,0.7071067811865476],"translation":[3,0,0]},
        {"camera":0},{"name":"side","camera":1,"translation":[0.3,0.3,9]}])";
    const Assembly scene =
        read_assembly(with_cameras(folder, nodes, "[0,1,3,4]", "[" + flat + "," + perspective + "]"), {}, 2);
    REQUIRE(scene.cameras.size() == 3);
    CHECK(scene.cameras[0].name == "side");
    CHECK(scene.cameras[1].name == "plan");
    CHECK(scene.cameras[2].name == "side.2");
    check_point(scene.cameras[0].scene_from_camera.origin, 16, 2, 0);
    check_point(scene.cameras[0].scene_from_camera.z, 1, 0, 0);
    CHECK(scene.cameras[0].vertical_field_rad == 0.5);
    CHECK_FALSE(scene.cameras[1].has_pose());

    Camera camera;
    camera.lens = io::read_lens("double-gauss-50mm");
    camera.film = default_film(camera.lens, {}, {});
    CHECK(set_view(camera, scene, {})->name == "side");
    check_point(*entrance_pupil_position_m(camera), 16, 2, 0, 1e-6);
    check_point(normalized(camera.pose.look_at_m - camera.pose.position_m), -1, 0, 0);
    ViewRequest request;
    request.camera = "side.2";
    CHECK(set_view(camera, scene, request)->name == "side.2");
    check_point(*entrance_pupil_position_m(camera), 0.6, 0.6, 18, 1e-6);
    // The triangle, at z = 0, is in focus.
    CHECK(camera.lens.focus_distance / 1000 == doctest::Approx(camera.pose.position_m.z));
    request.camera = "none";
    CHECK(set_view(camera, scene, request) == nullptr);
    request.camera = "plan";
    CHECK_THROWS_WITH_AS(set_view(camera, scene, request), doctest::Contains("orthographic"), InputError);
    request.camera = "front";
    CHECK_THROWS_WITH_AS(set_view(camera, scene, request), doctest::Contains("\"side\", \"plan\", \"side.2\""),
                         InputError);
    request.camera = "";
    request.position_m = Vec3d{0, 0, 3};
    CHECK(set_view(camera, scene, request) == nullptr);
    CHECK(camera.pose.position_m.z == 3);
    CHECK(has(error_of(with_cameras(folder, R"([{"mesh":0,"camera":2}])", "[0]", "[" + flat + "]")),
              "its camera does not exist; there are 1"));
}

TEST_CASE("glTF: what is said of extensions that are required and not read") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const auto said = [&](const std::string& name) {
        return error_of(
            folder.write("r.gltf", gltf(R"([{"mesh":0}])", "[0]", R"(,"extensionsRequired":[")" + name + R"("])")));
    };
    CHECK(
        has(said("KHR_texture_basisu"),
            "needs the glTF extension KHR_texture_basisu, which is not read; export its KTX2 pictures as PNG, JPEG or "
            "WebP"));
    CHECK(has(said("EXT_texture_avif"), "export its pictures as PNG or JPEG"));
    for (const std::string name : {"KHR_technique_webgl", "CESIUM_RTC", "VENDOR_something"}) {
        CHECK(has(said(name), name + ", which is not read; export it without that extension"));
        CHECK_FALSE(has(said(name), "compression"));
    }
    CHECK(said("EXT_mesh_gpu_instancing") == "no error");
}

TEST_CASE("glTF: a KTX2 picture without another format beside it is named, and a checker stands in") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    folder.write("wood.ktx2", "\xabKTX 20\xbb");
    const auto material = [&](const std::string& texture) {
        return folder.write(
            "k.gltf",
            gltf(R"([{"mesh":0}])", "[0]",
                 R"(,"extensionsUsed":["KHR_texture_basisu"],"images":[{"uri":"wood.ktx2"},{"uri":"wood.png"}],
                              "textures":[{)" +
                     texture + R"("extensions":{"KHR_texture_basisu":{"source":0}}}],
                              "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"));
    };
    const auto scene_of = [&](const std::string& path) {
        return *io::read_scene(path, {}, [](const std::string& file, std::span<const std::uint8_t>) {
                    return file.ends_with(".png") ? std::optional(DecodedImage{1, 1, std::vector<std::uint8_t>(4)})
                                                  : std::nullopt;
                }).static_geometry;
    };
    const Scene scene = scene_of(material(""));
    CHECK(warns(scene, "wood.ktx2"));
    CHECK(warns(scene, "cannot be read as a picture; a checker in magenta and black stands in"));
    CHECK(warns(scene, "the extension KHR_texture_basisu is not modelled"));
    folder.write("wood.png", "a picture");
    CHECK_FALSE(warns(scene_of(material(R"("source":1,)")), "cannot be read"));
}
