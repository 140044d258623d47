#pragma once
// Paths in a scene, many lanes at a time and one by one.

#include <cmath>

#include "both_traversals.hpp"
#include "doctest/doctest.h"
#include "render/path/advance_path.hpp"

namespace realcam::test {

/// The SceneT of advance_paths.
struct BvhRays {
    SceneBvhView bvh;

    template <int N>
    void intersect(const SceneRays<N>& rays, Hits<N>& hits) const {
        for (int i = 0; i < N; ++i) {
            if (!rays.active[i]) continue;
            const Hit hit = closest_hit<true>(bvh, rays.origin[i], rays.direction[i], rays.far[i]);
            hits.distance[i] = hit.distance;
            hits.triangle[i] = hit.triangle;
            hits.u[i] = hit.u;
            hits.v[i] = hit.v;
            hits.instance[i] = hit.instance;
        }
    }
    template <int N>
    void occluded(const SceneRays<N>& rays, std::int32_t (&hidden)[N]) const {
        for (int i = 0; i < N; ++i)
            hidden[i] = rays.active[i] && any_hit<true>(bvh, rays.origin[i], rays.direction[i], rays.far[i]);
    }
};

struct NoProbe {
    void enter(RenderStage) const {}
};

/// Starts of paths all around, which see a box of about 5 m.
template <int N>
void begin_all_around(int first, SampleBlock<N>& block, PathState<N>& path, PathResults<N>& results) {
    for (int i = 0; i < N; ++i) {
        const std::uint32_t number = hash32(static_cast<std::uint32_t>(first + i));
        const auto drawn = [&](std::uint32_t salt) { return 2 * unit_float(hash32(number, salt)) - 1; };
        block.column[i] = block.row[i] = 0;
        block.used[i] = 1;
        block.stream[i] = number;
        block.sample[i] = static_cast<std::uint32_t>(first + i) % 16;
        const Vec3f from = {6 * drawn(1), 2 + drawn(2), 6 * drawn(3)}, to = {2 * drawn(4), 0, 2 * drawn(5)};
        path.rays.origin.set(i, from);
        path.rays.direction.set(i, normalized(to - from));
        path.rays.far[i] = kFarAway;
        path.rays.active[i] = number % 8 != 0;
        path.rays.time[i] = 0;
        path.weight[i] = 0.5f;
        path.throughput.set(i, grey(0.5f));
        path.pdf[i] = kDelta;
        path.interior[i] = nullptr;
        results.irradiance.set(i, {0, 0, 0});
        results.depth[i] = kFarAway;
        results.weight[i] = 0.5f;
    }
}

template <SceneKind scene_kind, int N>
void follow(const BothTraversals& traversals, const PathSettings& settings, int first, PathResults<N>& results) {
    SampleBlock<N> block;
    PathState<N> path;
    begin_all_around(first, block, path, results);
    const BvhRays rays{traversals.bvh()};
    const SceneView scene = traversals.scene();
    for (int bounce = 0;
         advance_paths<scene_kind>(scene, CameraView{}, settings, block, bounce, rays, NoProbe(), path, results);)
        ++bounce;
}

/// Checks that each lane of a block yields the same path as a block of one lane, within `tolerance` relative to its
/// light.
template <SceneKind scene_kind>
void check_lanes(const Assembly& assembly, const PathSettings& settings, float tolerance) {
    constexpr int kLanes = 128;
    const BothTraversals traversals(assembly);
    PathResults<kLanes> all;
    follow<scene_kind>(traversals, settings, 0, all);
    int lit = 0;
    for (int i = 0; i < kLanes; ++i) {
        PathResults<1> one;
        follow<scene_kind>(traversals, settings, i, one);
        const Color a = all.irradiance[i], b = one.irradiance[0];
        const float error = largest({std::fabs(a.r - b.r), std::fabs(a.g - b.g), std::fabs(a.b - b.b)});
        CHECK(error <= tolerance * (largest(b) + 1e-6f));
        CHECK(all.depth[i] == one.depth[0]);
        lit += !is_black(b);
    }
    CHECK(lit > kLanes / 4);
}

inline void add_quad(Scene& scene, Vec3d a, Vec3d b, Vec3d c, Vec3d d, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    scene.positions_m.insert(scene.positions_m.end(), {a, b, c, d});
    scene.triangles.push_back({{first, first + 1, first + 2}, material});
    scene.triangles.push_back({{first, first + 2, first + 3}, material});
}

/// A floor, a wall and a lamp, of materials 0 to 2.
inline Scene lamp_room() {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].diffuse = {0.7f, 0.5f, 0.3f};
    scene.materials[1].diffuse = {0.2f, 0.4f, 0.6f};
    scene.materials[2].emission = {50, 40, 30};
    add_quad(scene, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}, 0);
    add_quad(scene, {-3, 0, -3}, {3, 0, -2.5}, {3, 2, -2.5}, {-3, 2, -3}, 1);
    add_quad(scene, {-1, 3, -1}, {1, 3, -1}, {1, 3.5, 1}, {-1, 3.5, 1}, 2);
    return scene;
}

struct AddedLight {
    const char* name;
    void (*add)(Scene&);
};

/// Lights that may be added to the room's lamp.
inline constexpr AddedLight kAddedLights[] = {
    {"a lamp alone", [](Scene&) {}},
    {"a constant sky", [](Scene& s) { s.environment.constant = {2, 3, 4}; }},
    {"two suns and a point",
     [](Scene& s) {
         s.suns = {{{0, -1, 0}, {3, 1, 0}}, {{0.6f, -0.8f, 0}, {0, 10, 0}}};
         s.points.push_back({{0.5, 1.5, 0.5}, {5, 6, 7}});
     }},
    {"an image all around",
     [](Scene& s) {
         s.environment.width = 4;
         s.environment.height = 2;
         s.environment.pixels = {{1, 2, 3}, {9, 9, 9}, {0, 1, 0}, {2, 2, 2},
                                 {1, 1, 1}, {0, 0, 0}, {3, 1, 2}, {1, 0, 1}};
     }},
};

inline const PathSettings kFollowedSettings[] = {PathSettings{0}, PathSettings{5},
                                                 PathSettings{5, LightTransport::paths, 1.0f},
                                                 PathSettings{3, LightTransport::whitted}};

}  // namespace realcam::test
