// The BVH of the CUDA backend, whose traversal runs on the host too: against every triangle in double precision, and
// against Embree.
#if defined(REALCAM_HAS_BVH)

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "../../cpp/bvh/build_wide_bvh.hpp"
#include "../../cpp/bvh/traverse_wide_bvh.hpp"
#include "../../cpp/embree/embree_api.hpp"
#include "../../cpp/math/sampling.hpp"
#include "../../cpp/scene/light_sample.hpp"
#include "doctest/doctest.h"

using namespace realcam;

namespace {

struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({{a, b, c}, 0}); }
    void add(Vec3f a, Vec3f b, Vec3f c) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        add(first, first + 1, first + 2);
    }
    WideBvh bvh() const { return build_wide_bvh(positions, triangles); }
};

struct Ray {
    Vec3f origin, direction;
    float far = kFarAway;
};

class Draw {
public:
    explicit Draw(std::uint32_t seed) : bits_(seed) {}

    float within(float a, float b) { return a + (b - a) * (static_cast<float>(bits_() >> 8) * 0x1p-24f); }
    std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(bits_() % n); }
    Vec3f in_cube(float half) { return {within(-half, half), within(-half, half), within(-half, half)}; }
    Vec3f direction() {
        for (;;) {
            const Vec3f d = in_cube(1);
            if (dot(d, d) > 0.01f && dot(d, d) < 1) return normalized(d);
        }
    }

private:
    std::mt19937 bits_;
};

Mesh soup(std::size_t count, float room, float size, std::uint32_t seed) {
    Draw draw(seed);
    Mesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f middle = draw.in_cube(room);
        mesh.add(middle + draw.in_cube(size), middle + draw.in_cube(size), middle + draw.in_cube(size));
    }
    return mesh;
}

// A closed mesh that is seen from inside: a sphere with bumps, the poles fans, no seam.
Mesh potato(int rings, int sectors, Vec3f middle, float radius, float bump) {
    Mesh mesh;
    const auto place = [&](double polar, double azimuth) {
        const double r =
            static_cast<double>(radius) * (1 + static_cast<double>(bump) * std::sin(5 * polar) * std::cos(4 * azimuth));
        return middle + Vec3f{static_cast<float>(r * std::sin(polar) * std::cos(azimuth)),
                              static_cast<float>(r * std::cos(polar)),
                              static_cast<float>(r * std::sin(polar) * std::sin(azimuth))};
    };
    const double pi = 3.141592653589793;
    mesh.positions = {place(0, 0), place(pi, 0)};
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) mesh.positions.push_back(place(pi * i / rings, 2 * pi * j / sectors));
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(2 + (i - 1) * sectors + j % sectors); };
    for (int j = 0; j < sectors; ++j) {
        mesh.add(0, at(1, j), at(1, j + 1));
        mesh.add(1, at(rings - 1, j + 1), at(rings - 1, j));
        for (int i = 1; i + 1 < rings; ++i) {
            mesh.add(at(i, j), at(i + 1, j), at(i, j + 1));
            mesh.add(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        }
    }
    return mesh;
}

struct ExactHit {
    double distance = std::numeric_limits<double>::infinity();
    double u = 0, v = 0;
    double margin = 0;  // least barycentric: how far inside the triangle, or outside if negative
};

// One triangle in double precision, Moller and Trumbore's way: nothing in common with the routine under test.
ExactHit exact_hit(const Mesh& mesh, std::size_t triangle, const Ray& ray) {
    const std::uint32_t* corner = mesh.triangles[triangle].vertices;
    const auto a = static_cast<Vec3d>(mesh.positions[corner[0]]);
    const Vec3d e1 = static_cast<Vec3d>(mesh.positions[corner[1]]) - a;
    const Vec3d e2 = static_cast<Vec3d>(mesh.positions[corner[2]]) - a;
    const auto d = static_cast<Vec3d>(ray.direction);
    const Vec3d p = cross(d, e2), from = static_cast<Vec3d>(ray.origin) - a, q = cross(from, e1);
    const double det = dot(e1, p);
    ExactHit hit;
    hit.margin = -std::numeric_limits<double>::infinity();
    if (det == 0) return hit;
    hit.u = dot(from, p) / det;
    hit.v = dot(d, q) / det;
    hit.distance = dot(e2, q) / det;
    hit.margin = std::min({hit.u, hit.v, 1 - hit.u - hit.v});
    return hit;
}

// What float corners relative to the ray's origin may cost, as a share of the barycentrics and of the distance: 16
// roundings of the farthest corner's distance, over the triangle's smallest height as the ray sees it, or the cosine.
struct Uncertainty {
    double barycentric, distance;
};
Uncertainty uncertainty(const Mesh& mesh, std::size_t triangle, const Ray& ray) {
    Vec3d p[3];
    double far = 0;
    for (int i = 0; i < 3; ++i) {
        p[i] =
            static_cast<Vec3d>(mesh.positions[mesh.triangles[triangle].vertices[i]]) - static_cast<Vec3d>(ray.origin);
        far = std::max(far, length(p[i]));
    }
    const Vec3d d = normalized(static_cast<Vec3d>(ray.direction)), area = cross(p[1] - p[0], p[2] - p[0]);
    const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    const double seen = std::fabs(dot(area, d)), rounding = 16 * 0x1p-24 * far;
    return {rounding * longest / seen, rounding * length(area) / seen};
}

// A ray against every triangle in double precision. False where the answers differ by more than float corners explain.
bool agrees(const Mesh& mesh, const WideBvhView& bvh, const Ray& ray) {
    const Hit hit = closest_hit(bvh, ray.origin, ray.direction, ray.far);
    const double unit = length(static_cast<Vec3d>(ray.direction)), far = static_cast<double>(ray.far);
    if (any_hit(bvh, ray.origin, ray.direction, ray.far) != (hit.triangle != kNoTriangle)) return false;
    double distance = far;
    if (hit.triangle != kNoTriangle) {
        if (hit.triangle >= mesh.triangles.size()) return false;
        const ExactHit exact = exact_hit(mesh, hit.triangle, ray);
        const Uncertainty may = uncertainty(mesh, hit.triangle, ray);
        distance = static_cast<double>(hit.distance);
        if (!(distance >= 0 && distance < far)) return false;
        // Where the triangle is seen from its edge, nothing but a hit's place in it can be said.
        if (may.barycentric < 0.5) {
            if (exact.margin < -may.barycentric) return false;
            if (std::fabs(distance - exact.distance) * unit > may.distance) return false;
            if (std::fabs(static_cast<double>(hit.u) - exact.u) > may.barycentric) return false;
            if (std::fabs(static_cast<double>(hit.v) - exact.v) > may.barycentric) return false;
        }
    }
    // No triangle that is surely met lies surely nearer.
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const ExactHit exact = exact_hit(mesh, i, ray);
        if (!(exact.margin > 0)) continue;
        const Uncertainty may = uncertainty(mesh, i, ray);
        if (exact.margin <= may.barycentric) continue;
        const double slack = may.distance / unit;
        if (exact.distance > slack && exact.distance + slack < distance - (hit.triangle == kNoTriangle ? 0 : slack))
            return false;
    }
    return true;
}

Ray ray_between(Vec3f from, Vec3f to) {
    return {from, to - from};
}

void check_rays(const Mesh& mesh, int count, const std::function<Ray(Draw&)>& next) {
    const WideBvh bvh = mesh.bvh();
    Draw draw(99);
    int wrong = 0, hits = 0;
    for (int i = 0; i < count; ++i) {
        const Ray ray = next(draw);
        wrong += !agrees(mesh, bvh.view(), ray);
        hits += any_hit(bvh.view(), ray.origin, ray.direction, ray.far);
    }
    CHECK(wrong == 0);
    CHECK(hits > count / 25);
}

// What must hold for every hierarchy: each triangle in exactly one slot, in the box of its slot and of all above, and
// the depth that a traversal's stack has room for.
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

// Triangles whose sizes and places span orders of magnitude, all of which a ray from the corner may meet.
Mesh many_sizes(int count, double orders, std::uint32_t seed) {
    Draw draw(seed);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto size = static_cast<float>(std::pow(10.0, orders * (i / (count - 1.0) - 0.5)));
        const Vec3f middle = size * (Vec3f{3, 3, 3} + draw.in_cube(1));
        mesh.add(middle + draw.in_cube(size), middle + draw.in_cube(size), middle + draw.in_cube(size));
    }
    return mesh;
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

TEST_CASE("wide BVH: the nearest hit is that of every triangle in double precision") {
    SUBCASE("a cloud, from inside and outside") {
        check_rays(soup(1000, 10, 2, 1), 3000, [](Draw& d) { return Ray{d.in_cube(20), d.direction(), kFarAway}; });
    }
    SUBCASE("directions of all lengths, near and far ends") {
        check_rays(soup(1000, 10, 2, 2), 3000, [](Draw& d) {
            const float scale = std::pow(10.0f, d.within(-30, 30));
            return Ray{d.in_cube(10), scale * d.direction(), d.within(0, 40) / scale};
        });
    }
    SUBCASE("an infinite end") {
        check_rays(soup(1000, 10, 2, 3), 1000,
                   [](Draw& d) { return Ray{d.in_cube(10), d.direction(), std::numeric_limits<float>::infinity()}; });
    }
    SUBCASE("slivers") {
        Draw draw(4);
        Mesh mesh;
        for (int i = 0; i < 1000; ++i) {
            const Vec3f a = draw.in_cube(10), along = 5.0f * draw.direction();
            mesh.add(a, a + along, a + 0.5f * along + draw.in_cube(0.01f));
        }
        check_rays(mesh, 3000, [&mesh](Draw& d) {
            return ray_between(d.in_cube(10), mesh.positions[d.below(mesh.positions.size())] + d.in_cube(0.01f));
        });
    }
    SUBCASE("degenerate triangles among others") {
        Mesh mesh = soup(500, 10, 2, 5);
        Draw draw(6);
        for (int i = 0; i < 500; ++i) {
            const Vec3f a = draw.in_cube(10), b = draw.in_cube(10);
            mesh.add(a, a, a);
            mesh.add(a, b, a);
            mesh.add(a, 0.5f * a + 0.5f * b, b);
        }
        check_rays(mesh, 2000, [](Draw& d) { return Ray{d.in_cube(10), d.direction()}; });
    }
    SUBCASE("sizes over 12 orders of magnitude") {
        const Mesh mesh = many_sizes(1200, 12, 7);
        check_rays(mesh, 3000,
                   [&mesh](Draw& d) { return ray_between({0, 0, 0}, mesh.positions[d.below(mesh.positions.size())]); });
        check_rays(mesh, 3000, [&mesh](Draw& d) {
            const std::uint32_t* t = mesh.triangles[d.below(mesh.triangles.size())].vertices;
            const Vec3f to = 0.3f * mesh.positions[t[0]] + 0.3f * mesh.positions[t[1]] + 0.4f * mesh.positions[t[2]];
            return ray_between(to + length(to) * d.in_cube(1), to);
        });
    }
    SUBCASE("huge and tiny scenes") {
        for (const float scale : {1e18f, 1e12f, 1e-9f, 1e-12f}) {
            Mesh mesh = soup(300, scale, 0.3f * scale, 8);
            check_rays(mesh, 1000, [scale](Draw& d) { return Ray{d.in_cube(scale), d.direction()}; });
        }
    }
    SUBCASE("a camera 1e5 times as far away as the scene is large") {
        const Mesh mesh = soup(1000, 10, 3, 9);
        check_rays(mesh, 3000, [](Draw& d) { return ray_between(1e6f * d.direction(), d.in_cube(8)); });
    }
    SUBCASE("directions with components of 0, -0 and less than normal") {
        const Mesh mesh = soup(1000, 10, 2, 10);
        for (const float small : {0.0f, -0.0f, 1e-40f, -1e-44f, 1e-30f, -1e-12f})
            for (int axis = 0; axis < 3; ++axis)
                check_rays(mesh, 300, [=](Draw& d) {
                    const float s = d.within(-1, 1) < 0 ? -1.0f : 1.0f;
                    const Vec3f along = axis == 0   ? Vec3f{s, small, small}
                                        : axis == 1 ? Vec3f{small, s, small}
                                                    : Vec3f{small, small, s};
                    return Ray{d.in_cube(10), along};
                });
    }
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
        Draw draw(11);
        int out = 0, strays = 0;
        for (int i = 0; i < 40000; ++i) {
            const Vec3f from = where.middle + draw.in_cube(0.3f * where.radius);
            const std::uint32_t* t = mesh.triangles[draw.below(mesh.triangles.size())].vertices;
            const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]];
            const float share = i % 2 ? draw.within(0, 1) : 0;
            const Ray ray = ray_between(from, a + share * (b - a));
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
                        const Ray ray = axis == 0   ? Ray{{3, p, q}, {sense, zero, zero}}
                                        : axis == 1 ? Ray{{p, 3, q}, {zero, sense, zero}}
                                                    : Ray{{p, q, 3}, {zero, zero, sense}};
                        const Hit hit = closest_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
                        // Rays within a face (i or j at an end) may meet its triangles from their edge or not; the
                        // face ahead must stop them.
                        wrong += hit.distance != (sense > 0 ? static_cast<float>(side) - 3 : 3.0f);
                        wrong += !any_hit(bvh.view(), ray.origin, ray.direction, kFarAway);
                        wrong += any_hit(bvh.view(), ray.origin, ray.direction, hit.distance);
                    }
    CHECK(wrong == 0);
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
    check_rays(mesh, 2000, [&mesh](Draw& d) {
        const std::uint32_t* t = mesh.triangles[d.below(mesh.triangles.size())].vertices;
        return Ray{0.25f * mesh.positions[t[0]] + 0.25f * mesh.positions[t[1]] + 0.5f * mesh.positions[t[2]],
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

TEST_CASE("wide BVH: hits are those of Embree") {
    const Mesh mesh = potato(200, 300, {1, 2, 3}, 5, 0.3f);
    const WideBvh bvh = mesh.bvh();
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3f), mesh.positions.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) std::copy_n(mesh.triangles[i].vertices, 3, corners + 3 * i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);

    Draw draw(14);
    int hits = 0, other = 0, wrong = 0;
    double distance = 0, barycentric = 0;
    constexpr int kRays = 64000;
    for (int first = 0; first < kRays; first += 16) {
        RTCRayHit16 packet;
        alignas(64) int valid[16];
        Ray rays[16];
        for (int k = 0; k < 16; ++k) {
            const Vec3f from = Vec3f{1, 2, 3} + draw.in_cube(12);
            rays[k] = {from, normalized(Vec3f{1, 2, 3} + draw.in_cube(6) - from)};
            valid[k] = -1;
            packet.ray.org_x[k] = rays[k].origin.x;
            packet.ray.org_y[k] = rays[k].origin.y;
            packet.ray.org_z[k] = rays[k].origin.z;
            packet.ray.dir_x[k] = rays[k].direction.x;
            packet.ray.dir_y[k] = rays[k].direction.y;
            packet.ray.dir_z[k] = rays[k].direction.z;
            packet.ray.tnear[k] = packet.ray.time[k] = 0;
            packet.ray.tfar[k] = kFarAway;
            packet.ray.mask[k] = 0xffffffffu;
            packet.ray.id[k] = packet.ray.flags[k] = 0;
            packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            packet.hit.primID[k] = kNoTriangle;
        }
        intersect16(valid, scene, RayOrder::incoherent, &packet);
        for (int k = 0; k < 16; ++k) {
            const Hit hit = closest_hit(bvh.view(), rays[k].origin, rays[k].direction, kFarAway);
            if (hit.triangle != packet.hit.primID[k]) {
                // Beside an edge either may be right: the exact ray then misses neither by much.
                ++other;
                for (const std::uint32_t t : {hit.triangle, packet.hit.primID[k]}) {
                    if (t == kNoTriangle) {
                        ++wrong;
                        continue;
                    }
                    const double margin = exact_hit(mesh, t, rays[k]).margin;
                    wrong += margin < -2 * uncertainty(mesh, t, rays[k]).barycentric;
                }
                continue;
            }
            if (hit.triangle == kNoTriangle) continue;
            ++hits;
            const Uncertainty may = uncertainty(mesh, hit.triangle, rays[k]);
            const auto off = [](float a, float b) {
                return std::fabs(static_cast<double>(a) - static_cast<double>(b));
            };
            distance = std::max(distance, off(hit.distance, packet.ray.tfar[k]) / may.distance);
            barycentric = std::max({barycentric, off(hit.u, packet.hit.u[k]) / may.barycentric,
                                    off(hit.v, packet.hit.v[k]) / may.barycentric});
        }
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    CHECK(hits > kRays / 5);
    CHECK(other < kRays / 1000);
    CHECK(wrong == 0);
    // In units of 16 roundings, each of the two being off by up to one.
    CHECK(distance < 2);
    CHECK(barycentric < 2);
}

TEST_CASE("wide BVH: refit gives the answers of a new build") {
    Mesh mesh = potato(60, 80, {0, 0, 0}, 3, 0.2f);
    WideBvh bvh = mesh.bvh();
    for (Vec3f& p : mesh.positions) p = Vec3f{2, -1, 0.5f} + Vec3f{1.5f * p.x + 0.2f * p.y * p.y, p.y, 0.7f * p.z};
    refit(bvh, mesh.positions);
    check_structure(mesh, bvh);
    const WideBvh fresh = mesh.bvh();
    Draw draw(15);
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
