// Skins and morph targets that an animation moves: vertices at any time by the formulas of the format
// (glTF 2.0, 3.7.2.2, 3.7.3.3 and appendix C). Also scenes of a file by name.

#include <cmath>
#include <numbers>
#include <string>

#include "../../../fuzz/scene_seeds.hpp"
#include "gltf_files.hpp"

namespace {

using namespace scene_files;

/// A glTF of one triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) whose parts are given as JSON, with further accessors of
/// floats.
struct DeformingGltf {
    DeformingGltf() {
        add("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
        add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    }

    /// Adds an accessor and returns its index.
    int add(const std::string& type, const std::vector<float>& numbers) {
        const std::size_t components = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type == "VEC4" ? 4 : 3;
        views += (views.empty() ? "" : ",") + (R"({"buffer":0,"byteOffset":)" + std::to_string(bytes.size())) +
                 R"(,"byteLength":)" + std::to_string(4 * numbers.size()) + "}";
        accessors += (accessors.empty() ? "" : ",") + (R"({"bufferView":)" + std::to_string(count)) +
                     R"(,"componentType":5126,"count":)" + std::to_string(numbers.size() / components) +
                     R"(,"type":")" + type + "\"}";
        bytes.append(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
        return count++;
    }

    /// Animates a node's path.
    void animate(int node, const std::string& path, const std::string& type, const std::vector<float>& times,
                 const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
        const int input = add("SCALAR", times), output = add(type, values);
        const std::string comma = samplers.empty() ? "" : ",";
        channels += comma + R"({"sampler":)" + std::to_string(sampler_count++) + R"(,"target":{"node":)" +
                    std::to_string(node) + R"(,"path":")" + path + "\"}}";
        samplers += comma + R"({"input":)" + std::to_string(input) + R"(,"output":)" + std::to_string(output) +
                    R"(,"interpolation":")" + interpolation + "\"}";
    }

    std::string text() const {
        return R"({"asset":{"version":"2.0"},"nodes":)" + nodes +
               R"(,"meshes":[{"name":"tri","primitives":[{"attributes":)" + R"({"POSITION":0,"NORMAL":1)" + attributes +
               "}" + primitive + R"(}]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
               R"(],"buffers":[{"byteLength":)" + std::to_string(bytes.size()) + R"(,"uri":"data:;base64,)" +
               fuzz::base64(bytes) + R"("}])" +
               (samplers.empty()
                    ? ""
                    : R"(,"animations":[{"channels":[)" + channels + R"(],"samplers":[)" + samplers + "]}]") +
               more + "}";
    }

    std::string nodes = R"([{"name":"tri","mesh":0}])", attributes, primitive, more;
    std::string bytes, views, accessors, channels, samplers;
    int count = 0, sampler_count = 0;
};

Assembly assembly_of(const Folder& folder, const DeformingGltf& gltf, const std::vector<std::string>& objects = {},
                     double scale = 1) {
    return read_assembly(folder.write("d.gltf", gltf.text()), objects, scale);
}

/// Returns a vertex in the scene of the only object, at a time.
Vec3d vertex(const Assembly& scene, double time, std::size_t index) {
    const Assembly frozen = frozen_at(scene, time);
    REQUIRE(frozen.instances.size() == 1);
    CHECK_FALSE(frozen.moves());
    const Scene& object = *frozen.instances[0].object;
    REQUIRE(object.positions_m.size() == 3);
    return frozen.instances[0].scene_from_object.point(object.positions_m[index]);
}

/// Positions and keys of the files are floats, and so are sums of displacements up to a rounding.
constexpr double kRounding = 2e-7;

void check_close(Vec3d p, Vec3d expected, double within = kRounding) {
    CHECK(length(p - expected) <= within);
}

}  // namespace

TEST_CASE("glTF: morph targets have the weights of their keyframes, in all interpolations") {
    const Folder folder;
    struct Case {
        std::string interpolation;
        std::vector<float> values;
        double (*first)(double);
    };
    // The first weight by the formula of each interpolation, from 0 at 1 s to 1 at 3 s; the second is half of it.
    const Case cases[] = {{"LINEAR", {0, 0, 1, 0.5f}, [](double t) { return t; }},
                          {"STEP", {0, 0, 1, 0.5f}, [](double t) { return t < 1 ? 0.0 : 1.0; }},
                          // In-tangents, values and out-tangents of both weights; out-tangent 3 at the first key,
                          // in-tangent -1 at the last.
                          {"CUBICSPLINE", {0, 0, 0, 0, 3, 1.5f, -1, -0.5f, 1, 0.5f, 0, 0}, [](double t) {
                               return 2 * 3 * (t * t * t - 2 * t * t + t) + 2 * -1 * (t * t * t - t * t) + 3 * t * t -
                                      2 * t * t * t;
                           }}};
    for (const Case& c : cases) {
        CAPTURE(c.interpolation);
        DeformingGltf gltf;
        const int a = gltf.add("VEC3", {0, 0, 1, 0, 0, 2, 0.5f, 0, 0}),
                  b = gltf.add("VEC3", {0, 4, 0, 0, 0, 0, 0, 0, 0});
        const int turned = gltf.add("VEC3", {1, 0, -1, 1, 0, -1, 1, 0, -1});
        gltf.primitive = R"(,"targets":[{"POSITION":)" + std::to_string(a) + R"(,"NORMAL":)" + std::to_string(turned) +
                         R"(},{"POSITION":)" + std::to_string(b) + "}]";
        gltf.animate(0, "weights", "SCALAR", {1, 3}, c.values, c.interpolation);
        const Assembly scene = assembly_of(folder, gltf, {}, 2);
        CHECK(scene.static_geometry->triangles.empty());
        REQUIRE(scene.instances.size() == 1);
        CHECK(scene.instances[0].name == "tri");
        CHECK(scene.moves());
        CHECK(warns(*scene.static_geometry, "1 meshes change their shape over time"));
        for (const double time : {0.0, 1.0, 1.3, 2.0, 2.9, 3.0, 7.0}) {
            const double t = std::clamp((time - 1) / 2, 0.0, 1.0), w = c.first(t);
            CAPTURE(time);
            check_close(vertex(scene, time, 0), 2.0 * Vec3d{0, 2 * w, w}, 1e-6);
            check_close(vertex(scene, time, 1), 2.0 * Vec3d{1, 0, 2 * w}, 1e-6);
            check_close(vertex(scene, time, 2), 2.0 * Vec3d{0.5 * w, 1, 0}, 1e-6);
            const Vec3d n = normalized(Vec3d{w, 0, 1 - w});
            check_vec(frozen_at(scene, time).instances[0].object->normals[0], n.x, n.y, n.z, 1e-5);
        }
    }
}

TEST_CASE("glTF: constant keyframes of weights are applied once, and the mesh stays static") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.primitive =
        R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})) + "}]";
    gltf.animate(0, "weights", "SCALAR", {0, 1}, {0.5f, 0.5f});
    const Assembly scene = assembly_of(folder, gltf);
    CHECK(scene.instances.empty());
    check_close(scene.static_geometry->positions_m[0], {0, 0, 0.5});
}

TEST_CASE("glTF: a skin follows its joints at every time, by linear blend skinning") {
    const Folder folder;
    DeformingGltf gltf;
    // Joints 1 and 2: the second stands at (0, 0.5, 0) and turns about z by a right angle from 0 to 2 s. The node of
    // the mesh has a transform, which does not count.
    gltf.nodes =
        R"([{"name":"skinned","mesh":0,"skin":0,"translation":[9,9,9]},{"children":[2]},{"translation":[0,0.5,0]}])";
    const int joints = gltf.add("VEC4", {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
    gltf.accessors.replace(gltf.accessors.rfind("5126"), 4, "5125");  // whole numbers of 32 bits
    const std::uint32_t indices[] = {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    gltf.bytes.replace(gltf.bytes.size() - sizeof indices, sizeof indices, reinterpret_cast<const char*>(indices),
                       sizeof indices);
    const int weights = gltf.add("VEC4", {1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 1, 0, 0, 0});
    gltf.attributes = R"(,"JOINTS_0":)" + std::to_string(joints) + R"(,"WEIGHTS_0":)" + std::to_string(weights);
    const int binds = gltf.add(
        "MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5f, 0, 1});
    gltf.more = R"(,"skins":[{"joints":[1,2],"inverseBindMatrices":)" + std::to_string(binds) + "}]";
    const float half = static_cast<float>(std::sqrt(0.5));
    gltf.animate(2, "rotation", "VEC4", {0, 2}, {0, 0, 0, 1, 0, 0, half, half});
    const Assembly scene = assembly_of(folder, gltf);
    REQUIRE(scene.instances.size() == 1);
    CHECK(scene.instances[0].name == "skinned");
    for (const double time : {0.0, 0.4, 1.0, 2.0, 5.0}) {
        CAPTURE(time);
        const double angle = std::min(time, 2.0) / 2 * std::numbers::pi / 2, c = std::cos(angle), s = std::sin(angle);
        check_close(vertex(scene, time, 0), {0, 0, 0});
        // (1, 0, 0) is (1, -0.5, 0) from the joint.
        check_close(vertex(scene, time, 1), 0.25 * Vec3d{1, 0, 0} + 0.75 * Vec3d{c + 0.5 * s, 0.5 + s - 0.5 * c, 0});
        check_close(vertex(scene, time, 2), {-0.5 * s, 0.5 + 0.5 * c, 0});
    }

    // A constant skin is applied, and a node above all of it moves the mesh as a whole.
    gltf.nodes =
        R"([{"mesh":0,"skin":0},{"children":[2]},{"translation":[0,0.5,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476]},{"name":"all","children":[0,1]}])";
    gltf.channels = gltf.samplers = "";
    gltf.sampler_count = 0;
    gltf.animate(3, "translation", "VEC3", {0, 1}, {0, 0, 0, 8, 0, 0});
    const Assembly rigid = assembly_of(folder, gltf);
    REQUIRE(rigid.instances.size() == 1);
    CHECK(rigid.instances[0].object->deformation == nullptr);
    check_close(vertex(rigid, 0.5, 2), {3.5, 0.5, 0});
}

TEST_CASE("glTF: a mesh that deforms moves with the object that contains it") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.nodes =
        R"([{"name":"car","translation":[1,0,0],"children":[1]},{"name":"flag","mesh":0,"translation":[0,2,0]}])";
    gltf.primitive =
        R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})) + "}]";
    gltf.animate(1, "weights", "SCALAR", {0, 1}, {0, 1});
    gltf.animate(0, "translation", "VEC3", {0, 1}, {1, 0, 0, 5, 0, 0});
    const Assembly driven = assembly_of(folder, gltf);
    check_close(vertex(driven, 0.5, 1), {4, 2, 0.5});
    Assembly moved = assembly_of(folder, gltf, {"flag"});
    CHECK(moved.instances[0].name == "flag");
    Affine<double> to;
    to.origin = {0, 0, 7};
    move(moved, 0, to);
    check_close(vertex(moved, 0.5, 1), {1, 0, 7.5});
}

TEST_CASE("glTF: a shape without area for a while has no triangles then") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.primitive =
        R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 0, -1, 0, 0, 0, -1, 0})) + "}]";
    gltf.animate(0, "weights", "SCALAR", {0, 1}, {1, 0});
    const Assembly scene = assembly_of(folder, gltf);
    CHECK(frozen_at(scene, 0).instances[0].object->triangles.empty());
    CHECK(frozen_at(scene, 0.5).instances[0].object->triangles.size() == 1);
}

TEST_CASE("glTF: a mesh that deforms below a node scaled to zero is left out") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.nodes = R"([{"name":"hidden","mesh":0,"scale":[0,0,0]},{"name":"floor","mesh":1}])";
    gltf.primitive = R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})) +
                     R"(}]}]},{"primitives":[{"attributes":{"POSITION":0})";
    gltf.animate(0, "weights", "SCALAR", {0, 1}, {0, 1});
    const Assembly scene = assembly_of(folder, gltf);
    CHECK(scene.instances.empty());
    CHECK(scene.static_geometry->triangles.size() == 1);
    CHECK(warns(*scene.static_geometry, "node \"hidden\" is scaled to zero while it moves or changes its shape"));
}

TEST_CASE("glTF: shapes of one time are computed once") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.primitive =
        R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})) + "}]";
    gltf.animate(0, "weights", "SCALAR", {0, 1}, {0, 1});
    const Assembly scene = assembly_of(folder, gltf);
    Shapes shapes;
    const Assembly first = with_shapes_at(scene, 0.5, shapes), second = with_shapes_at(scene, 0.5, shapes);
    CHECK(same_parts(first, second));
    CHECK(first.instances[0].object != scene.instances[0].object);
}

TEST_CASE("glTF: keyframes of weights that do not fit the targets are refused") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.primitive =
        R"(,"targets":[{"POSITION":)" + std::to_string(gltf.add("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1})) + "}]";
    gltf.animate(0, "weights", "SCALAR", {0, 1}, {0, 1, 2});
    CHECK(has(error_of(folder.write("e.gltf", gltf.text())),
              "animation 0: channel 0: has 2 times and 3 values; expected 1 for each time"));
}

TEST_CASE("glTF: a scene is chosen by its name or its index") {
    const Folder folder;
    DeformingGltf gltf;
    gltf.nodes = R"([{"mesh":0},{"mesh":0,"translation":[0,0,3]},{"mesh":0,"translation":[0,0,5]}])";
    gltf.more = R"(,"scene":1,"scenes":[{"name":"hall","nodes":[0]},{"name":"yard","nodes":[1]},{"nodes":[2]}])";
    const std::string path = folder.write("s.gltf", gltf.text());
    Reader reader;
    const auto height = [&](const std::string& name) {
        const io::SceneFileOptions options{.scene_name = name};
        return io::read_scene(path, options, reader.function()).static_geometry->positions_m[0].z;
    };
    CHECK(height("") == 3);
    CHECK(height("hall") == 0);
    CHECK(height("yard") == 3);
    CHECK(height("2") == 5);
    CHECK(warns(read(path), "of 3 scenes, scene 1 \"yard\" is read"));
    CHECK_THROWS_WITH_AS(height("halls"),
                         doctest::Contains("has no scene \"halls\" (did you mean \"hall\"?); expected the name or the "
                                           "index of one of its 3 scenes"),
                         SceneFileError);
    const io::SceneFileOptions options{.scene_name = "hall"};
    CHECK_THROWS_WITH_AS(io::read_scene(folder.write("s.obj", "v 0 0 0\n"), options, {}),
                         doctest::Contains("scenes are selected in a glTF file"), InputError);
}
