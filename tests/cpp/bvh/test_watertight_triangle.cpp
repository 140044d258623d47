// Edges and corners: no ray slips between two triangles of the BVH.
#if defined(REALCAM_HAS_BVH)

#include <cmath>

#include "bvh_rays.hpp"
#include "doctest/doctest.h"

using namespace realcam;
using namespace realcam::test;

TEST_CASE("difference of products: the sign is right, and the error less than 1.5 units in the last place") {
    // Products of floats are exact in double, and their difference is correctly rounded: the truth.
    BvhDraw draw(21);
    int wrong = 0, zeros = 0;
    for (int i = 0; i < 200000; ++i) {
        const float a = draw.within(-1, 1), b = draw.within(-1, 1);
        // Nearly or exactly the same product: nothing but rounding is left of the difference.
        const auto near = [&](float v) { return v * (1 + static_cast<float>(draw.below(5)) * 0x1p-23f); };
        const float c = i % 3 ? near(b) : draw.within(-1, 1), d = i % 3 ? near(a) : draw.within(-1, 1);
        const double exact =
            static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(c) * static_cast<double>(d);
        const float found = difference_of_products(a, b, c, d);
        const double last_place = std::ldexp(1.0, std::ilogb(exact == 0 ? 1.0 : exact) - 23);
        wrong += !(std::fabs(static_cast<double>(found) - exact) <= 1.5 * last_place);
        wrong += (exact > 0) != (found > 0) || (exact < 0) != (found < 0);
        wrong += (difference_of_products(c, d, a, b) > 0) != (found < 0);
        zeros += exact == 0;
    }
    CHECK(wrong == 0);
    CHECK(zeros > 1000);
}

TEST_CASE("wide BVH: no ray slips out through an edge or a corner of a closed mesh") {
    struct Where {
        Vec3f middle;
        float radius, bump;
        int rings, sectors;
    };
    for (const Where& where : {Where{{0, 0, 0}, 1, 0.1f, 40, 60}, Where{{0, 0, 0}, 1, 0, 5, 7},
                               Where{{300, -200, 1000}, 1, 0.1f, 60, 90}, Where{{0, 0, 0}, 1e15f, 0.1f, 40, 60},
                               Where{{0, 0, 0}, 1e-6f, 0.1f, 40, 60}, Where{{10, 0, 0}, 1, 0.2f, 3, 700}}) {
        const Mesh mesh = potato(where.rings, where.sectors, where.middle, where.radius, where.bump);
        const WideBvh bvh = mesh.bvh();
        BvhDraw draw(11);
        int out = 0, strays = 0;
        for (int i = 0; i < 40000; ++i) {
            const Vec3f from = where.middle + draw.in_cube(0.3f * where.radius);
            const std::uint32_t* t = mesh.triangles[draw.below(mesh.triangles.size())].vertices;
            const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]];
            const float share = i % 2 ? draw.within(0, 1) : 0;
            const BvhRay ray = ray_between(from, a + share * (b - a));
            const Hit hit = closest_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
            out += hit.triangle == kNoTriangle;
            out += !any_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
            // From inside a star-shaped mesh the aim is the one thing to be met.
            strays += where.bump == 0 && !(std::fabs(hit.distance - 1) < 1e-3f);
        }
        CHECK(out == 0);
        CHECK(strays == 0);
    }
}

TEST_CASE("wide BVH: rays along an axis through the corners, edges and faces of a closed grid") {
    // A box of unit squares: every ray from inside, in planes of the grid, runs exactly into edges.
    constexpr int side = 8;
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (int end = 0; end < 2; ++end)
            for (int i = 0; i < side; ++i)
                for (int j = 0; j < side; ++j) {
                    const auto at = [&](int u, int v) {
                        const auto fixed = static_cast<float>(end * side), p = static_cast<float>(u),
                                   q = static_cast<float>(v);
                        return axis == 0 ? Vec3f{fixed, p, q} : axis == 1 ? Vec3f{p, fixed, q} : Vec3f{p, q, fixed};
                    };
                    mesh.add(at(i, j), at(i + 1, j), at(i, j + 1));
                    mesh.add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                }
    const WideBvh bvh = mesh.bvh();
    int wrong = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sense : {1.0f, -1.0f})
            for (const float zero : {0.0f, -0.0f})
                for (int i = 0; i <= 2 * side; ++i)
                    for (int j = 0; j <= 2 * side; ++j) {
                        const float p = 0.5f * static_cast<float>(i), q = 0.5f * static_cast<float>(j);
                        const BvhRay ray = axis == 0   ? BvhRay{{3, p, q}, {sense, zero, zero}}
                                           : axis == 1 ? BvhRay{{p, 3, q}, {zero, sense, zero}}
                                                       : BvhRay{{p, q, 3}, {zero, zero, sense}};
                        const Hit hit = closest_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
                        // Rays within a face (i or j at an end) may meet its triangles from their edge or not; the
                        // face ahead must stop them.
                        wrong += hit.distance != (sense > 0 ? static_cast<float>(side) - 3 : 3.0f);
                        wrong += !any_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
                        wrong += any_hit(bvh.view(), ray.origin, ray.direction, hit.distance);
                    }
    CHECK(wrong == 0);
}

#endif
