// KHR_draco_mesh_compression and EXT_meshopt_compression: meshes that the libraries' own encoders have written,
// compared with the vertices before compression, and refused input.

#include <cmath>
#include <string>

#include "../../../fuzz/compressed_meshes.hpp"
#include "gltf_files.hpp"

namespace {

using namespace scene_files;
using namespace realcam::fuzz;

const GridMesh kGrid(16);

/// Greatest errors of a scene that should be kGrid, whose texture coordinates are its x and y.
struct Errors {
    double position = 0, normal_rad = 0;
    std::size_t triangles = 0;
};

/// Vertices are found by their texture coordinates, because encoders change their order.
Errors errors_of(const Scene& scene) {
    Errors errors;
    errors.triangles = scene.triangles.size();
    REQUIRE(scene.uvs.size() == scene.positions_m.size());
    REQUIRE(scene.normals.size() == scene.positions_m.size());
    REQUIRE(scene.positions_m.size() == kGrid.vertices());
    for (std::size_t i = 0; i < scene.uvs.size(); ++i) {
        const auto column = static_cast<std::size_t>(std::lround(16 * scene.uvs[i].x));
        const auto row = static_cast<std::size_t>(std::lround(16 * (1 - scene.uvs[i].y)));
        const float *p = &kGrid.positions[3 * (17 * row + column)], *n = &kGrid.normals[3 * (17 * row + column)];
        const Vec3d position = static_cast<Vec3d>(Vec3f{p[0], p[1], p[2]}),
                    difference = scene.positions_m[i] - position;
        for (const double d : {difference.x, difference.y, difference.z})
            errors.position = std::max(errors.position, std::abs(d));
        const Vec3d expected = static_cast<Vec3d>(Vec3f{n[0], n[1], n[2]}),
                    normal = static_cast<Vec3d>(scene.normals[i]);
        errors.normal_rad =
            std::max(errors.normal_rad, std::atan2(length(cross(expected, normal)), dot(expected, normal)));
    }
    // Every triangle faces upwards and has half the area of a cell, seen from above.
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const Vec3d a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
        CHECK(cross(b - a, c - a).z == doctest::Approx(1.0 / 256).epsilon(0.05));
    }
    return errors;
}

/// Bound on the angle of a normal whose octahedral coordinates, in -1..1, are rounded by up to `half_step` each. On the
/// octahedron |z| = 1 - |x| - |y|, so that the point moves by at most sqrt(1 + 1 + 2^2) half_step; its distance from
/// the origin is at least 1 / sqrt(3).
double octahedral_bound_rad(double half_step) {
    return std::sqrt(18.0) * half_step;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

#if REALCAM_HAS_DRACO

TEST_CASE("glTF: Draco meshes have the vertices of their uncompressed form, up to half a step of the quantisation") {
    const Folder folder;
    for (const bool is_edgebreaker : {true, false})
        for (const int bits : {8, 11, 14, 0})
            for (const int speed : {0, 5, 10}) {
                CAPTURE(is_edgebreaker);
                CAPTURE(bits);
                CAPTURE(speed);
                const std::string coded = draco_bytes(kGrid, {is_edgebreaker, bits, 10, 0, speed});
                const Scene scene = read(folder.write("d.glb", glb_of(draco_json(kGrid, coded.size()), coded)));
                CHECK(scene.warnings.empty());
                const Errors errors = errors_of(scene);
                CHECK(errors.triangles == 512);
                // The range of the quantisation is the largest extent, 1. Rounding of floats adds 2^-23.
                CHECK(errors.position <= (bits == 0 ? 0 : 0.5 / (std::exp2(bits) - 1) + std::exp2(-23)));
                CHECK(errors.normal_rad <= octahedral_bound_rad(1 / (std::exp2(10) - 2)) + 1e-6);
            }
}

TEST_CASE("glTF: a Draco mesh that does not fit its accessors is refused before it is decoded") {
    const Folder folder;
    const std::string coded = draco_bytes(kGrid, {}), json = draco_json(kGrid, coded.size());
    const auto error = [&](const std::string& text, const std::string& bytes) {
        return error_of(folder.write("e.glb", glb_of(text, bytes)));
    };
    CHECK(has(error(replaced(json, R"("count":1536)", R"("count":1539)"), coded),
              "mesh 0: its Draco mesh has 289 vertices and 512 triangles; its accessors have 289 vertices and 513"));
    CHECK(has(error(replaced(json, R"("count":289)", R"("count":290)"), coded), "its accessors have 290 vertices"));
    CHECK(has(error(replaced(json, R"("count":289)", R"("count":99)"), coded), "its accessors have 99 vertices"));
    CHECK(has(error(replaced(json, R"("count":289)", R"("count":99999999)"), coded), "at most 16777216 of each"));
    CHECK(has(error(replaced(json, R"("NORMAL":1,"TEXCOORD_0":2}})", R"("NORMAL":7,"TEXCOORD_0":2}})"), coded),
              "its Draco attribute 7 does not exist"));
    CHECK(has(error(replaced(json, R"("NORMAL":1,"TEXCOORD_0":2}})", R"("NORMAL":2,"TEXCOORD_0":2}})"), coded),
              "its Draco attribute 2 has 2 components; its accessor expects 3"));
    CHECK(has(error(replaced(json, R"("bufferView":0)", R"("bufferView":4)"), coded), "there are 1"));
    CHECK(has(error(replaced(json, R"("indices":3,)", ""), coded), "has no indices, which a Draco mesh needs"));
    CHECK(has(error(replaced(json, R"("indices":3,)", R"("indices":3,"mode":5,)"), coded), "must have the mode 4"));
    CHECK(has(error(json, std::string(coded.size(), 'x')), "is not a Draco mesh"));
    std::string version = coded;
    version[6] = 1;
    CHECK(has(error(json, version), "has Draco's bitstream 2.1; glTF has 2.2"));
    std::string cut = coded.substr(0, coded.size() / 2);
    CHECK(has(error(draco_json(kGrid, cut.size()), cut), "its Draco mesh is not valid"));
    cut.resize(12);
    CHECK(has(error(draco_json(kGrid, cut.size()), cut), "its Draco mesh is cut short"));
}

#endif

#if REALCAM_HAS_MESHOPT

TEST_CASE("glTF: meshes of EXT_meshopt_compression have the vertices of their uncompressed form") {
    const Folder folder;
    for (const bool are_triangles : {true, false}) {
        const MeshoptWriter writer = meshopt_grid(kGrid, are_triangles);
        std::string json = meshopt_json(kGrid, writer);
        const Assembly turned = read_assembly(folder.write("m.glb", glb_of(json, writer.bytes)), {});
        CHECK(turned.static_geometry->warnings.empty());
        REQUIRE(turned.instances.size() == 1);
        const Errors errors = errors_of(*turned.instances[0].object);
        CHECK(errors.triangles == 512);
        // The mantissa of 15 bits with its sign, of vectors whose exponent is at most 1.
        CHECK(errors.position <= std::exp2(1 - kMeshoptPositionBits));
        // Octahedral coordinates and, after decoding, x, y and z are rounded to 1/127.
        CHECK(errors.normal_rad <= octahedral_bound_rad(0.5 / 127) + std::sqrt(3.0) * 0.5 / 127);
        // The turn by 120 degrees takes x to y. The components of a quaternion are rounded by 1 / (2 sqrt(2) 2047), the
        // largest one follows from the others (1/2 each), and an entry of the matrix changes by four times as much.
        const Affine<double> first = turned.instances[0].transform_at(0), last = turned.instances[0].transform_at(1);
        const double bound = 4 * std::sqrt(12.0) / (2 * std::sqrt(2.0) * 2047);
        CHECK(length(first.x - Vec3d{0, 1, 0}) <= bound);
        CHECK(length(last.x - Vec3d{0, 0, 1}) <= bound);
    }
}

TEST_CASE("glTF: bufferViews of EXT_meshopt_compression that are wrong are refused") {
    const Folder folder;
    const MeshoptWriter writer = meshopt_grid(kGrid, true);
    const std::string json = meshopt_json(kGrid, writer);
    const auto error = [&](const std::string& text, const std::string& bytes) {
        return error_of(folder.write("e.glb", glb_of(text, bytes)));
    };
    const std::string normals = R"("byteStride":4,"count":289,"mode":"ATTRIBUTES","filter":"OCTAHEDRAL")";
    const auto with_normals = [&](const std::string& changed) {
        return error(replaced(json, normals, changed), writer.bytes);
    };
    CHECK(has(with_normals(R"("byteStride":4,"count":2890000,"mode":"ATTRIBUTES")"),
              "mesh 0: NORMAL: accessor 1: bufferView 1: promises 2890000 elements of 4 bytes, for which"));
    CHECK(has(with_normals(R"("byteStride":6,"count":289,"mode":"ATTRIBUTES")"),
              "its byteStride is \"6\"; expected a multiple of 4 up to 256"));
    CHECK(has(with_normals(R"("byteStride":4,"count":289,"mode":"VERTICES")"),
              "its mode is \"VERTICES\"; expected ATTRIBUTES, TRIANGLES or INDICES"));
    CHECK(has(with_normals(R"("byteStride":12,"count":289,"mode":"ATTRIBUTES","filter":"QUATERNION")"),
              "its byteStride is \"12\"; expected 8 with the filter QUATERNION"));
    CHECK(has(with_normals(R"("byteStride":4,"count":289,"mode":"ATTRIBUTES","filter":"COLOR")"),
              "its filter is \"COLOR\"; expected OCTAHEDRAL, QUATERNION or EXPONENTIAL"));
    CHECK(has(with_normals(R"("byteStride":4,"count":288,"mode":"ATTRIBUTES")"), "its compressed bytes are not valid"));
    CHECK(has(error(replaced(json, R"("count":1536,"mode")", R"("count":1535,"mode")"), writer.bytes),
              "its count is \"1535\"; expected a multiple of 3"));
    std::string bytes = writer.bytes;
    bytes[0] = 'x';
    CHECK(has(error(json, bytes), "its compressed bytes are not valid for 289 elements of 12 bytes"));
}

#endif

#if !REALCAM_HAS_DRACO || !REALCAM_HAS_MESHOPT

TEST_CASE(
    "glTF: without the library of a codec, uncompressed data are read, and the library is named if there are none") {
    const Folder folder;
    folder.write("tri.bin", triangle_bytes());
    const std::string plain = gltf(R"([{"mesh":0}])", "[0]");
    if (!REALCAM_HAS_DRACO) {
        const std::string both = replaced(
            plain, R"("indices":3,"material":0)",
            R"("indices":3,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})");
        CHECK(read(folder.write("d.gltf", both)).triangles.size() == 1);
        for (const std::string accessor :
             {R"("bufferView":0,"componentType":5126,)", R"("bufferView":3,"componentType":5123,)"})
            CHECK(
                has(error_of(folder.write("d.gltf", replaced(both, accessor, accessor.substr(15)))),
                    "its triangles are in the glTF extension KHR_draco_mesh_compression, which needs libdraco, without "
                    "which this realcam was built; export it without compression"));
    }
    if (!REALCAM_HAS_MESHOPT) {
        const std::string both = replaced(
            plain, R"("bufferViews":[{"buffer":0,"byteLength":36)",
            R"("bufferViews":[{"buffer":0,"byteLength":36,"extensions":{"EXT_meshopt_compression":{"buffer":0}})");
        CHECK(read(folder.write("m.gltf", both)).triangles.size() == 1);
        const std::string alone =
            replaced(both, R"(,"uri":"tri.bin")", R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}})");
        CHECK(has(error_of(folder.write("m.gltf", alone)), "meshoptimizer, without which this realcam was built"));
    }
}

#endif
