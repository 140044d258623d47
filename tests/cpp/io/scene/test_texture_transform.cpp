// Texture transforms: glTF's KHR_texture_transform and MTL's -s and -o.

#include <cmath>

#include "gltf_files.hpp"
#include "io/gltf/gltf_file.hpp"
#include "io/scene/texture_transform.hpp"

using namespace scene_files;
using io::TextureTransform;

namespace {

Vec2f by_reference(const TextureReference& reference, Vec2f uv) {
    const Vec3f u = reference.to_u, v = reference.to_v;
    return {u.x * uv.x + u.y * uv.y + u.z, v.x * uv.x + v.y * uv.y + v.z};
}

// Coordinates of some units in float: a rounding of 1e-7 at each of four operations.
void check_uv(Vec2f uv, double u, double v) {
    CHECK(std::abs(double(uv.x) - u) < 1e-6);
    CHECK(std::abs(double(uv.y) - v) < 1e-6);
}

constexpr Vec2f kSome[] = {{0, 0}, {1, 0}, {0, 1}, {0.25f, 0.75f}, {-1.5f, 2.25f}};

}  // namespace

TEST_CASE("a texture transform scales, turns and moves as glTF says, for vertices and for renderers") {
    const double su = 0.5, sv = -2, angle = 0.7, ou = 0.3, ov = -1.1;
    const TextureTransform transform(su, sv, angle, ou, ov);
    const TextureReference reference = transform.reference(7);
    CHECK(reference.texture == 7);
    for (const Vec2f uv : kSome) {
        // The extension's matrices, translation * rotation * scale by columns, of (u, 1 - v).
        const double x = su * double(uv.x), y = sv * (1 - double(uv.y));
        const double u = std::cos(angle) * x + std::sin(angle) * y + ou;
        const double v = -std::sin(angle) * x + std::cos(angle) * y + ov;
        check_uv(transform(uv.x, uv.y), u, 1 - v);
        check_uv(by_reference(reference, uv), u, 1 - v);
    }
    for (const Vec2f uv : kSome) {
        check_uv(TextureTransform()(uv.x, uv.y), double(uv.x), double(uv.y));
        check_uv(by_reference(TextureTransform().reference(0), uv), double(uv.x), double(uv.y));
        check_uv(by_reference(TextureReference{}, uv), double(uv.x), double(uv.y));
    }
}

TEST_CASE("MTL's options multiply and add, with v upwards") {
    const TextureTransform transform = TextureTransform::of_mtl(2, -3, 0.25, 0.5);
    for (const Vec2f uv : kSome) {
        check_uv(transform(uv.x, uv.y), 2 * double(uv.x) + 0.25, -3 * double(uv.y) + 0.5);
        check_uv(by_reference(transform.reference(0), uv), 2 * double(uv.x) + 0.25, -3 * double(uv.y) + 0.5);
    }
    CHECK(TextureTransform::of_mtl(1, 1, 0, 0) == TextureTransform());
    CHECK(TextureTransform::of_mtl(1, 1, 0, 1e-9) != TextureTransform());
}

TEST_CASE("a transform that no float holds is found") {
    CHECK(TextureTransform(2, 2, 1, 1e30, 1).is_finite());
    CHECK_FALSE(TextureTransform(1e300, 1, 0, 0, 0).is_finite());
    CHECK_FALSE(TextureTransform(1, 1, HUGE_VAL, 0, 0).is_finite());
    CHECK_FALSE(TextureTransform(1, 1, 0, 0, -1e39).is_finite());
}
