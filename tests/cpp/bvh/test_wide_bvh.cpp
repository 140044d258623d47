// The BVH of the CUDA backend, whose traversal runs on the host too: against every triangle in double precision.
#if defined(REALCAM_HAS_BVH)

#include <functional>
#include <limits>

#include "bvh_rays.hpp"
#include "doctest/doctest.h"

using namespace realcam;
using namespace realcam::test;

namespace {

void check_rays(const Mesh& mesh, int count, const std::function<BvhRay(BvhDraw&)>& next) {
    const WideBvh bvh = mesh.bvh();
    BvhDraw draw(99);
    int wrong = 0, hits = 0;
    for (int i = 0; i < count; ++i) {
        const BvhRay ray = next(draw);
        wrong += !agrees(mesh, bvh.view(), ray);
        hits += any_hit(bvh.view(), ray.origin, ray.direction, ray.far);
    }
    CHECK(wrong == 0);
    CHECK(hits > count / 25);
}

}  // namespace

TEST_CASE("wide BVH: the nearest hit is that of every triangle in double precision") {
    SUBCASE("a cloud, from inside and outside") {
        check_rays(soup(1000, 10, 2, 1), 3000,
                   [](BvhDraw& d) { return BvhRay{d.in_cube(20), d.direction(), kFarAway}; });
    }
    SUBCASE("directions of all lengths, near and far ends") {
        check_rays(soup(1000, 10, 2, 2), 3000, [](BvhDraw& d) {
            const float scale = std::pow(10.0f, d.within(-30, 30));
            return BvhRay{d.in_cube(10), scale * d.direction(), d.within(0, 40) / scale};
        });
    }
    SUBCASE("an infinite end") {
        check_rays(soup(1000, 10, 2, 3), 1000, [](BvhDraw& d) {
            return BvhRay{d.in_cube(10), d.direction(), std::numeric_limits<float>::infinity()};
        });
    }
    SUBCASE("slivers") {
        BvhDraw draw(4);
        Mesh mesh;
        for (int i = 0; i < 1000; ++i) {
            const Vec3f a = draw.in_cube(10), along = 5.0f * draw.direction();
            mesh.add(a, a + along, a + 0.5f * along + draw.in_cube(0.01f));
        }
        check_rays(mesh, 3000, [&mesh](BvhDraw& d) {
            return ray_between(d.in_cube(10), mesh.positions[d.below(mesh.positions.size())] + d.in_cube(0.01f));
        });
    }
    SUBCASE("degenerate triangles among others") {
        Mesh mesh = soup(500, 10, 2, 5);
        BvhDraw draw(6);
        for (int i = 0; i < 500; ++i) {
            const Vec3f a = draw.in_cube(10), b = draw.in_cube(10);
            mesh.add(a, a, a);
            mesh.add(a, b, a);
            mesh.add(a, 0.5f * a + 0.5f * b, b);
        }
        check_rays(mesh, 2000, [](BvhDraw& d) { return BvhRay{d.in_cube(10), d.direction()}; });
    }
    SUBCASE("sizes over 12 orders of magnitude") {
        const Mesh mesh = many_sizes(1200, 12, 7);
        check_rays(mesh, 3000, [&mesh](BvhDraw& d) {
            return ray_between({0, 0, 0}, mesh.positions[d.below(mesh.positions.size())]);
        });
        check_rays(mesh, 3000, [&mesh](BvhDraw& d) {
            const std::uint32_t* t = mesh.triangles[d.below(mesh.triangles.size())].vertices;
            const Vec3f to = 0.3f * mesh.positions[t[0]] + 0.3f * mesh.positions[t[1]] + 0.4f * mesh.positions[t[2]];
            return ray_between(to + length(to) * d.in_cube(1), to);
        });
    }
    SUBCASE("huge and tiny scenes") {
        for (const float scale : {1e18f, 1e12f, 1e-9f, 1e-12f}) {
            Mesh mesh = soup(300, scale, 0.3f * scale, 8);
            check_rays(mesh, 1000, [scale](BvhDraw& d) { return BvhRay{d.in_cube(scale), d.direction()}; });
        }
    }
    SUBCASE("a camera 1e5 times as far away as the scene is large") {
        const Mesh mesh = soup(1000, 10, 3, 9);
        check_rays(mesh, 3000, [](BvhDraw& d) { return ray_between(1e6f * d.direction(), d.in_cube(8)); });
    }
    SUBCASE("directions with components of 0, -0 and less than normal") {
        const Mesh mesh = soup(1000, 10, 2, 10);
        for (const float small : {0.0f, -0.0f, 1e-40f, -1e-44f, 1e-30f, -1e-12f})
            for (int axis = 0; axis < 3; ++axis)
                check_rays(mesh, 300, [=](BvhDraw& d) {
                    const float s = d.within(-1, 1) < 0 ? -1.0f : 1.0f;
                    const Vec3f along = axis == 0   ? Vec3f{s, small, small}
                                        : axis == 1 ? Vec3f{small, s, small}
                                                    : Vec3f{small, small, s};
                    return BvhRay{d.in_cube(10), along};
                });
    }
}

TEST_CASE("wide BVH: rays that start on a surface meet it at 0, and go on from beyond") {
    const Mesh mesh = soup(2000, 10, 1, 12);
    const WideBvh bvh = mesh.bvh();
    int missed = 0;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        // From a corner: exactly on the triangle.
        const Vec3f corner = mesh.positions[mesh.triangles[i].vertices[0]];
        const Vec3f inside = (1 / 3.0f) * (mesh.positions[mesh.triangles[i].vertices[1]] - corner) +
                             (1 / 3.0f) * (mesh.positions[mesh.triangles[i].vertices[2]] - corner);
        const Vec3f across = cross(inside, mesh.positions[mesh.triangles[i].vertices[1]] - corner);
        if (length(across) < 1e-4f) continue;
        const Hit hit = closest_hit(bvh.view(), corner, normalized(across), kFarAway);
        missed += hit.triangle == kNoTriangle || hit.distance != 0;
    }
    CHECK(missed == 0);
    check_rays(mesh, 2000, [&mesh](BvhDraw& d) {
        const std::uint32_t* t = mesh.triangles[d.below(mesh.triangles.size())].vertices;
        return BvhRay{0.25f * mesh.positions[t[0]] + 0.25f * mesh.positions[t[1]] + 0.5f * mesh.positions[t[2]],
                      d.direction()};
    });
}

TEST_CASE("wide BVH: rays that are none meet nothing") {
    const Mesh mesh = soup(1000, 1, 1, 13);
    const WideBvh bvh = mesh.bvh();
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    REQUIRE(any_hit(bvh.view(), {0, 0, 0}, {0, 0, 1}, kFarAway));
    for (const float bad : {nan, inf, -inf}) {
        CHECK_FALSE(any_hit(bvh.view(), {bad, 0, 0}, {0, 0, 1}, kFarAway));
        CHECK_FALSE(any_hit(bvh.view(), {0, 0, bad}, {0, 0, 1}, kFarAway));
        CHECK_FALSE(any_hit(bvh.view(), {0, 0, 0}, {0, bad, 1}, kFarAway));
        CHECK(closest_hit(bvh.view(), {0, 0, 0}, {bad, bad, bad}, kFarAway).triangle == kNoTriangle);
    }
    CHECK_FALSE(any_hit(bvh.view(), {0, 0, 0}, {0, 0, 0}, kFarAway));
    for (const float end : {0.0f, -0.0f, -1.0f, nan, -inf}) CHECK_FALSE(any_hit(bvh.view(), {0, 0, 0}, {0, 0, 1}, end));
    CHECK_FALSE(any_hit(Mesh{}.bvh().view(), {0, 0, 0}, {0, 0, 1}, kFarAway));
}

#endif
