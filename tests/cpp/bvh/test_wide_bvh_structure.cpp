// Guarantees of the BVH builder for triangles, boxes, slots and depth; and the refit.
#if defined(REALCAM_HAS_BVH)

#include <algorithm>
#include <cmath>

#include "bvh/collapse.hpp"
#include "bvh/quantised_boxes.hpp"
#include "bvh/reinsertion.hpp"
#include "bvh/slot_order.hpp"
#include "bvh_rays.hpp"
#include "doctest/doctest.h"

using namespace realcam;
using namespace realcam::test;

namespace {

// Invariants of every hierarchy: each triangle is in exactly one slot, inside the boxes of its slot and of all its
// ancestors, and the depth fits a traversal's stack.
struct Structure {
    const Mesh& mesh;
    const WideBvh& bvh;
    std::vector<int> seen = std::vector<int>(mesh.triangles.size());
    unsigned depth = 0;
    std::size_t nodes = 0;
    bool boxes_hold = true;

    Structure(const Mesh& m, const WideBvh& b) : mesh(m), bvh(b) { visit(0, 1, {}); }

    struct BoxD {
        Vec3d lower, upper;
    };
    static BoxD box_of_slot(const WideNode& node, unsigned s) {
        const auto step = [](std::uint32_t bits) { return static_cast<double>(std::bit_cast<float>(bits)); };
        const double steps[3] = {step(node.steps_xy & 0xffff0000u), step(node.steps_xy << 16),
                                 step(node.step_z_reach & 0xffff0000u)};
        const auto plane = [&](const std::uint32_t (&words)[3][2], int axis) {
            return (words[axis][s / 4] >> (8 * (s % 4)) & 0xffu) * steps[axis];
        };
        const auto origin = static_cast<Vec3d>(node.origin);
        return {origin + Vec3d{plane(node.lower, 0), plane(node.lower, 1), plane(node.lower, 2)},
                origin + Vec3d{plane(node.upper, 0), plane(node.upper, 1), plane(node.upper, 2)}};
    }
    void visit(std::uint32_t index, unsigned level, std::vector<BoxD> above) {
        ++nodes;
        depth = std::max(depth, level);
        REQUIRE(index < bvh.nodes.size());
        const WideNode& node = bvh.nodes[index];
        std::uint32_t triangle = node.first_triangle, child = node.first_child;
        for (unsigned s = 0; s < kSlots; ++s) {
            above.push_back(box_of_slot(node, s));
            const unsigned in_slot = node.content >> (3 * s) & 7u;
            CHECK((in_slot & (in_slot + 1)) == 0);
            if (node.content >> (24 + s) & 1u) {
                CHECK(in_slot == 0);
                CHECK(child > index);
                visit(child++, level + 1, above);
            }
            for (unsigned i = 0; i < count_bits(in_slot); ++i) check(triangle++, above);
            above.pop_back();
        }
    }
    void check(std::uint32_t number, const std::vector<BoxD>& above) {
        REQUIRE(number < bvh.triangles.size());
        const BvhTriangle& t = bvh.triangles[number];
        REQUIRE(t.index < seen.size());
        ++seen[t.index];
        const Vec3f* places[3] = {&t.a, &t.b, &t.c};
        for (int i = 0; i < 3; ++i) {
            const Vec3f corner = mesh.positions[mesh.triangles[t.index].vertices[i]];
            boxes_hold &= corner.x == places[i]->x && corner.y == places[i]->y && corner.z == places[i]->z;
            const auto p = static_cast<Vec3d>(corner);
            for (const BoxD& box : above)
                boxes_hold &= p.x >= box.lower.x && p.y >= box.lower.y && p.z >= box.lower.z && p.x <= box.upper.x &&
                              p.y <= box.upper.y && p.z <= box.upper.z;
        }
    }
};

void check_structure(const Mesh& mesh, const WideBvh& bvh) {
    const Structure found(mesh, bvh);
    CHECK(found.nodes == bvh.nodes.size());
    CHECK(std::count(found.seen.begin(), found.seen.end(), 1) == static_cast<std::ptrdiff_t>(found.seen.size()));
    CHECK(found.boxes_hold);
    CHECK(found.depth <= kMaxBvhDepth);
}

}  // namespace

TEST_CASE("wide BVH: every triangle is in one slot and in its boxes, and the depth has a bound") {
    Mesh one, none;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    check_structure(none, none.bvh());
    check_structure(one, one.bvh());
    for (const std::size_t count : {2u, 3u, 4u, 8u, 9u, 30u, 1000u, 30000u}) {
        const Mesh mesh = soup(count, 10, 0.3f, static_cast<std::uint32_t>(count));
        check_structure(mesh, mesh.bvh());
    }
    SUBCASE("sizes of 36 orders of magnitude, up to 1e18: a chain") {
        const Mesh mesh = many_sizes(3000, 36, 5);
        check_structure(mesh, mesh.bvh());
    }
    SUBCASE("a chain that is too deep: each triangle half as large as the last, and a crowd at the end") {
        Mesh mesh = soup(5000, 1e-30f, 1e-31f, 1);
        for (float size = 1e-29f; size < 1e18f; size *= 1.1f) mesh.add({size, 0, 0}, {0, size, 0}, {0, 0, size});
        check_structure(mesh, mesh.bvh());
    }
    SUBCASE("one place for all") {
        Mesh mesh;
        for (int i = 0; i < 5000; ++i) mesh.add({1, 2, 3}, {2, 2, 3}, {1, 3, 3});
        check_structure(mesh, mesh.bvh());
    }
    SUBCASE("points, and boxes without a volume") {
        Mesh mesh;
        for (int i = 0; i < 500; ++i) {
            const auto x = static_cast<float>(i % 7), y = static_cast<float>(i % 11);
            mesh.add({x, y, 0}, {x, y, 0}, {x, y, 0});
            mesh.add({x, y, 1e6f}, {x + 1, y, 1e6f}, {x, y + 1, 1e6f});
        }
        check_structure(mesh, mesh.bvh());
    }
}

TEST_CASE("wide BVH: quantised boxes hold the boxes, whatever their sizes") {
    BvhDraw draw(22);
    int open = 0, loose = 0;
    for (int i = 0; i < 20000; ++i) {
        Box boxes[kSlots] = {};
        const unsigned used = draw.below(255) + 1;
        for (Box& box : boxes)
            for (float Vec3f::* axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
                const auto number = [&] {
                    return std::ldexp(draw.within(-1, 1), static_cast<int>(draw.below(120)) - 60);
                };
                const float a = number(), b = number();
                box.lower.*axis = std::min(a, b);
                box.upper.*axis = std::max(a, b);
            }
        // The distance from -1 to almost 0 is 128 steps to all digits of double, and yet less.
        if (i % 2) {
            boxes[0].lower.x = -1;
            boxes[0].upper.x = 255 * 0x1p-7f - 1;
            boxes[1] = {{-1e-30f, 0, 0}, {-1e-35f, 0, 0}};
            for (unsigned s = 2; s < kSlots; ++s) boxes[s] = boxes[1];
        }
        WideNode node = {};
        quantise_boxes(node, boxes, used);
        for (unsigned s = 0; s < kSlots; ++s) {
            if (!(used >> s & 1u)) continue;
            const auto held = Structure::box_of_slot(node, s);
            const auto lower = static_cast<Vec3d>(boxes[s].lower), upper = static_cast<Vec3d>(boxes[s].upper);
            for (double Vec3d::* axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
                open += !(held.lower.*axis <= lower.*axis && held.upper.*axis >= upper.*axis);
            // At most a step too large on each side, of 255 or, as steps have eight bits, a few less to the node.
            double all = 0;
            for (unsigned k = 0; k < kSlots; ++k)
                for (unsigned l = 0; l < kSlots; ++l)
                    if (used >> k & used >> l & 1u)
                        all = std::max(all,
                                       static_cast<double>(boxes[k].upper.y) - static_cast<double>(boxes[l].lower.y));
            const double step = 1.01 * all / 255;
            loose += lower.y - held.lower.y > step || held.upper.y - upper.y > step;
        }
    }
    CHECK(open == 0);
    CHECK(loose == 0);
}

TEST_CASE("wide BVH: children in the eight corners of a node are met from the near corner to the far one") {
    BvhDraw draw(23);
    for (int i = 0; i < 200; ++i) {
        unsigned corner[kSlots] = {0, 1, 2, 3, 4, 5, 6, 7}, slot_of[kSlots];
        for (unsigned k = kSlots; k-- > 1;) std::swap(corner[k], corner[draw.below(k + 1)]);
        Box boxes[kSlots];
        for (unsigned c = 0; c < kSlots; ++c) {
            const auto side = [&](unsigned axis) { return corner[c] >> axis & 1u ? 1.0f : -1.0f; };
            const Vec3f middle = Vec3f{side(0), 2 * side(1), 3 * side(2)} + draw.in_cube(0.3f);
            boxes[c] = {middle - Vec3f{0.1f, 0.1f, 0.1f}, middle + Vec3f{0.1f, 0.1f, 0.1f}};
        }
        order_slots(boxes, kSlots, slot_of);
        for (unsigned c = 0; c < kSlots; ++c) CHECK(slot_of[c] == corner[c]);

        // No slot comes before one that lies on its near side along one axis, and level with it along the others.
        const Vec3f d = draw.direction();
        const SlabRay ray({0, 0, 0}, d);
        const unsigned away = (d.x < 0 ? 1u : 0u) | (d.y < 0 ? 2u : 0u) | (d.z < 0 ? 4u : 0u);
        unsigned left = 0xffu;
        while (left) {
            const unsigned next = ray.nearest(left);
            CHECK(count_bits(next & left) == 1);
            const auto slot = static_cast<unsigned>(std::countr_zero(next));
            for (unsigned axis = 1; axis < kSlots; axis *= 2)
                if ((slot ^ away) & axis) CHECK((left >> (slot ^ axis) & 1u) == 0);
            left ^= next;
        }
    }
}

TEST_CASE("wide BVH: moving the largest nodes makes the boxes smaller, and leaves a tree") {
    struct Sum {
        double area = 0;
        std::vector<int> seen;
        bool fits = true;

        void add(const BinaryNode& node) {
            if (node.is_leaf()) {
                ++seen[node.triangle];
                return;
            }
            area += half_area(node.box);
            std::uint32_t triangles = 0;
            for (const BinaryNode* child : node.inner().child) {
                add(*child);
                triangles += child->triangles;
                Box box = node.box;
                grow(box, child->box);
                fits &= half_area(box) == half_area(node.box) && child->parent == &node;
            }
            fits &= triangles == node.triangles;
        }
    };
    // Heaps of crumbs on a floor of two triangles, which each split from above leaves with one of the heaps.
    Mesh mesh;
    BvhDraw draw(25);
    for (int heap = 0; heap < 60; ++heap) {
        const Vec3f middle = draw.in_cube(40);
        for (int i = 0; i < 50; ++i) {
            const Vec3f a = Vec3f{middle.x, 1, middle.z} + draw.in_cube(1);
            mesh.add(a, a + draw.in_cube(0.2f), a + draw.in_cube(0.2f));
        }
    }
    mesh.add({-50, 0, -50}, {-50, 0, 50}, {50, 0, -50});
    mesh.add({50, 0, 50}, {-50, 0, 50}, {50, 0, -50});
    BinaryTree tree(mesh.triangles.size(), [&](std::uint32_t i) { return mesh.box(i); }, {});
    measure(tree.root());
    Sum before{0, std::vector<int>(mesh.triangles.size())}, after = before;
    before.add(tree.root());
    reinsert_largest(tree.root());
    after.add(tree.root());
    CHECK(after.fits);
    CHECK(std::count(after.seen.begin(), after.seen.end(), 1) == static_cast<std::ptrdiff_t>(mesh.triangles.size()));
    CHECK(after.area < 0.9 * before.area);
}

TEST_CASE("wide BVH: refit gives the answers of a new build") {
    Mesh mesh = potato(60, 80, {0, 0, 0}, 3, 0.2f);
    WideBvh bvh = mesh.bvh();
    for (Vec3f& p : mesh.positions) p = Vec3f{2, -1, 0.5f} + Vec3f{1.5f * p.x + 0.2f * p.y * p.y, p.y, 0.7f * p.z};
    refit(bvh, mesh.positions);
    check_structure(mesh, bvh);
    const WideBvh fresh = mesh.bvh();
    BvhDraw draw(15);
    int different = 0, hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3f from = draw.in_cube(8), d = normalized(draw.in_cube(4) - from);
        const Hit a = closest_hit(bvh.view(), from, d, kFarAway), b = closest_hit(fresh.view(), from, d, kFarAway);
        // On an edge the order of the visit decides which of the two is named, and so the barycentrics.
        different += a.distance != b.distance && std::fabs(a.distance - b.distance) > 1e-5f;
        hits += a.triangle != kNoTriangle;
    }
    CHECK(different == 0);
    CHECK(hits > 2000);

    Mesh nothing;
    WideBvh empty = nothing.bvh();
    refit(empty, nothing.positions);
    CHECK_FALSE(any_hit(empty.view(), {0, 0, 0}, {0, 0, 1}, kFarAway));
}

#endif
