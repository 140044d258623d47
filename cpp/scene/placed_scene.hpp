#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// A scene as kernels read it: float, relative to an origin near the camera, so that a scene far from its own origin
/// loses nothing. Owns the memory of its view; the Scene must outlive it.
class PlacedScene {
public:
    PlacedScene(const Scene& scene, Vec3d origin_m) : scene_(scene), origin_(origin_m) {
        positions_.reserve(scene.positions_m.size());
        for (const Vec3d& p : scene.positions_m) positions_.push_back(static_cast<Vec3f>(p - origin_m));
        for (const PlacedPointLight& p : scene.points)
            points_.push_back({static_cast<Vec3f>(p.position_m - origin_m), p.intensity});
        for (const Texture& t : scene.textures) textures_.push_back({t.rgba.data(), t.width, t.height});
        add_area_lights();
        if (!scene.environment.pixels.empty()) add_environment_cdf();
    }

    SceneView view() const {
        SceneView view{};
        view.triangles = scene_.triangles.data();
        view.positions = positions_.data();
        view.normals = scene_.normals.empty() ? nullptr : scene_.normals.data();
        view.uvs = scene_.uvs.empty() ? nullptr : scene_.uvs.data();
        view.materials = scene_.materials.data();
        view.textures = textures_.data();
        view.points = points_.data();
        view.suns = scene_.suns.data();
        view.areas = areas_.data();
        view.area_cdf = area_cdf_.data();
        view.point_count = static_cast<std::int32_t>(points_.size());
        view.sun_count = static_cast<std::int32_t>(scene_.suns.size());
        view.area_count = static_cast<std::int32_t>(areas_.size());
        view.has_environment = scene_.environment.shines();
        view.environment = {
            scene_.environment.constant, scene_.environment.pixels.empty() ? nullptr : scene_.environment.pixels.data(),
            marginal_cdf_.data(),        conditional_cdf_.data(),
            scene_.environment.width,    scene_.environment.height};
        return view;
    }

    const Scene& scene() const { return scene_; }
    Vec3d origin_m() const { return origin_; }
    const std::vector<Vec3f>& positions() const { return positions_; }

private:
    static double luminance(Vec3f rgb) {
        const Vec3d c = static_cast<Vec3d>(rgb);
        return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    }

    /// Turns weights into count + 1 cumulative probabilities; returns their sum.
    static double accumulate(const std::vector<double>& weights, std::vector<float>& cdf) {
        double total = 0;
        for (double w : weights) total += w;
        double sum = 0;
        cdf.push_back(0.0f);
        for (double w : weights)
            cdf.push_back(
                static_cast<float>((sum += total > 0 ? w / total : 1.0 / static_cast<double>(weights.size()))));
        cdf.back() = 1.0f;
        return total;
    }

    void add_area_lights() {
        std::vector<double> power;
        for (const Triangle& t : scene_.triangles) {
            const Vec3f emission = scene_.materials[t.material].emission;
            if (!(luminance(emission) > 0)) continue;
            const Vec3f a = positions_[t.vertices[0]], u = positions_[t.vertices[1]] - a,
                        v = positions_[t.vertices[2]] - a;
            const Vec3f normal = cross(u, v);
            const float twice_area = length(normal);
            if (!(twice_area > 0)) continue;
            areas_.push_back({a, u, v, (1 / twice_area) * normal, emission, 0.5f * twice_area, 0.0f});
            power.push_back(luminance(emission) * static_cast<double>(twice_area));
        }
        if (areas_.empty()) return;
        accumulate(power, area_cdf_);
        // What the rounded cumulative values give, so that density and choice agree.
        for (std::size_t i = 0; i < areas_.size(); ++i) areas_[i].probability = area_cdf_[i + 1] - area_cdf_[i];
    }

    void add_environment_cdf() {
        const Environment& e = scene_.environment;
        std::vector<double> rows;
        for (std::int32_t row = 0; row < e.height; ++row) {
            std::vector<double> weights;
            const double sine = std::sin(3.141592653589793 * (row + 0.5) / e.height);
            for (std::int32_t column = 0; column < e.width; ++column)
                weights.push_back(sine *
                                  luminance(e.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(e.width) +
                                                     static_cast<std::size_t>(column)]));
            rows.push_back(accumulate(weights, conditional_cdf_));
        }
        accumulate(rows, marginal_cdf_);
    }

    const Scene& scene_;
    Vec3d origin_;
    std::vector<Vec3f> positions_;
    std::vector<PointLight> points_;
    std::vector<TextureView> textures_;
    std::vector<AreaLight> areas_;
    std::vector<float> area_cdf_, marginal_cdf_, conditional_cdf_;
};

}  // namespace REALCAM_NAMESPACE
