#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "light_tables.hpp"
#include "scene.hpp"
#include "split_triangles.hpp"

namespace REALCAM_NAMESPACE {

/// A scene as kernels read it: float, relative to an origin near the camera, so that a scene far from its own origin
/// loses nothing. What is measured between corners (planes, areas, edges) comes from their double positions. Owns the
/// memory of its view; the Scene must outlive it.
class PlacedScene {
public:
    PlacedScene(const Scene& scene, Vec3d origin_m) : scene_(scene), origin_(origin_m), split_(scene, origin_m) {
        positions_.reserve(split_.position_count());
        for (std::size_t i = 0; i < split_.position_count(); ++i)
            positions_.push_back(static_cast<Vec3f>(split_.position(i)));
        for (const PlacedPointLight& p : scene.points)
            points_.push_back({static_cast<Vec3f>(p.position_m - origin_m), p.intensity});
        for (const Texture& t : scene.textures) textures_.push_back({t.rgba.data(), t.width, t.height});
        add_planes();
        add_area_lights();
        if (!scene.environment.pixels.empty()) environment_ = environment_tables(scene.environment);
    }

    SceneView view() const {
        SceneView view{};
        view.triangles = triangles().data();
        view.planes = planes_.data();
        view.positions = positions_.data();
        view.normals = split_.normals().empty() ? nullptr : split_.normals().data();
        view.uvs = split_.uvs().empty() ? nullptr : split_.uvs().data();
        view.materials = scene_.materials.data();
        view.textures = textures_.data();
        view.points = points_.data();
        view.suns = scene_.suns.data();
        view.areas = areas_.data();
        view.area_cdf = area_cdf_.empty() ? nullptr : area_cdf_.data();
        view.triangle_count = static_cast<std::int32_t>(triangles().size());
        view.vertex_count = static_cast<std::int32_t>(positions_.size());
        view.material_count = static_cast<std::int32_t>(scene_.materials.size());
        view.texture_count = static_cast<std::int32_t>(textures_.size());
        view.point_count = static_cast<std::int32_t>(points_.size());
        view.sun_count = static_cast<std::int32_t>(scene_.suns.size());
        view.area_count = static_cast<std::int32_t>(areas_.size());
        view.has_environment = scene_.environment.shines();
        view.environment = {scene_.environment.constant,
                            scene_.environment.pixels.empty() ? nullptr : scene_.environment.pixels.data(),
                            environment_.marginal_cdf.data(),
                            environment_.conditional_cdf.data(),
                            scene_.environment.width,
                            scene_.environment.height};
        return view;
    }

    const Scene& scene() const { return scene_; }
    Vec3d origin_m() const { return origin_; }
    const std::vector<Vec3f>& positions() const { return positions_; }
    /// The scene's, of which those that are large and near are in pieces.
    const std::vector<Triangle>& triangles() const { return split_.triangles(); }

private:
    /// Corner and edges of a triangle, as exact as the scene gives them.
    struct Edges {
        Vec3d corner, u, v;
    };
    template <class PositionOf>
    static Edges edges_of(const Triangle& t, PositionOf&& position) {
        const Vec3d a = position(t.vertices[0]);
        return {a, position(t.vertices[1]) - a, position(t.vertices[2]) - a};
    }

    void add_planes() {
        planes_.reserve(triangles().size());
        for (std::size_t i = 0; i < triangles().size(); ++i) {
            // Of the whole triangle, so that its pieces are one plane.
            const Edges whole = edges_of(scene_.triangles[split_.parent(i)],
                                         [&](std::uint32_t v) { return scene_.positions_m[v] - origin_; });
            const Vec3d area = cross(whole.u, whole.v);
            const double size = length(area);
            const Vec3d normal = size > 0 ? (1 / size) * area : Vec3d{0, 0, 1};
            double reach = 0;
            for (const std::uint32_t v : triangles()[i].vertices) {
                const Vec3f p = positions_[v];
                reach = std::max({reach, std::fabs(static_cast<double>(p.x)), std::fabs(static_cast<double>(p.y)),
                                  std::fabs(static_cast<double>(p.z))});
            }
            planes_.push_back({static_cast<Vec3f>(normal), static_cast<float>(dot(normal, whole.corner)),
                               static_cast<float>(static_cast<double>(kMarginShare) * reach + 1e-12)});
        }
    }

    void add_area_lights() {
        std::vector<std::uint32_t> materials;
        std::vector<double> areas;
        for (std::size_t i = 0; i < triangles().size(); ++i) {
            const Triangle& t = triangles()[i];
            const Vec3f emission = scene_.materials[t.material].emission;
            if (!(luminance(emission) > 0)) continue;
            const Edges edges = edges_of(t, [&](std::uint32_t v) { return split_.position(v); });
            const double area = 0.5 * length(cross(edges.u, edges.v));
            if (!(area > 0)) continue;
            areas_.push_back({static_cast<Vec3f>(edges.corner), static_cast<Vec3f>(edges.u),
                              static_cast<Vec3f>(edges.v), planes_[i].normal, emission, 0.0f, planes_[i].margin});
            areas.push_back(area);
            materials.push_back(t.material);
        }
        area_cdf_ = area_light_cdf(areas_, areas, materials, scene_.materials.size());
    }

    const Scene& scene_;
    Vec3d origin_;
    SplitTriangles split_;
    std::vector<Vec3f> positions_;
    std::vector<TrianglePlane> planes_;
    std::vector<PointLight> points_;
    std::vector<TextureView> textures_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_cdf_;
    EnvironmentTables environment_;
};

}  // namespace REALCAM_NAMESPACE
