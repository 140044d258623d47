#include "light_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../scene/bounding_box.hpp"
#include "../scene/light.hpp"

namespace realcam {
namespace {

/// Largest share of a pixel's samples that hit a lamp which is traced. If more hit it, samples of pixels have less
/// noise than samples from the lamp would.
constexpr double kLargestShare = 0.8;
/// Share of the band between neighbouring groups that emits, from which they are one surface in focus. A pixel that is
/// partly beside one group sees the next.
constexpr double kSurfaceShare = 0.25;

/// Region that the samples of one pixel see at a distance: the blur's disc, swept over the pixel. m.
struct Footprint {
    double blur;   ///< radius of the disc
    double pixel;  ///< side of a square of the pixel's area

    /// Area of the sum of a disc and a square.
    double area() const { return std::numbers::pi * blur * blur + 4 * blur * pixel + pixel * pixel; }
    /// Largest size of a group. The diagonal of a bounding box is up to 1.73 times as long as a round lamp is wide.
    double size() const { return 2 * (blur + pixel); }
};

class Grouping {
public:
    Grouping(const SceneView& scene, const CameraView& camera)
        : scene_(scene), camera_(camera), front_(front_vertex(camera, camera.front_vertex_m)) {}

    std::vector<LightGroup> all() && {
        if (scene_.light_node_count > 0) look_at(0, -1);
        for (std::int32_t i = 0; i < scene_.sun_count; ++i) groups_.push_back({TracedLightKind::sun, {i}});
        return std::move(groups_);
    }

private:
    /// Footprint of a pixel in the middle of the film, at the distance of a point.
    Footprint footprint(Vec3f point) const {
        const float mm = 1000 * length(point - front_);
        const auto at_distance = [&](float value, float slope) {
            return 1e-3 * std::fabs(static_cast<double>(value) + static_cast<double>(mm) * static_cast<double>(slope));
        };
        const CircleOfConfusion& circle = camera_.circle;
        const double pixel_mm2 = 4 * static_cast<double>(camera_.film_half_width) *
                                 static_cast<double>(camera_.film_half_height) / camera_.width / camera_.height;
        return {at_distance(circle.rim, circle.rim_slope),
                std::sqrt(pixel_mm2) * at_distance(circle.middle, circle.middle_slope)};
    }

    /// Whether light leaves the triangle towards some place of the lens's front.
    bool shines(const AreaLight& light) const {
        if (light.is_two_sided || light.instance != kNoInstance || camera_.key_count > 0) return true;
        const double reach_m = 2e-3 * std::fabs(static_cast<double>(camera_.circle.rim));
        return static_cast<double>(dot(front_ - light.corner, light.normal)) > -reach_m;
    }

    /// f(number) of all lights of a node: point lights, and behind them area lights.
    template <class F>
    void for_lights(std::int32_t at, F&& f) const {
        const LightNode& node = scene_.light_nodes[at];
        if (node.second_child > 0) {
            for_lights(at + 1, f);
            for_lights(node.second_child, f);
            return;
        }
        if (node.partner >= -1) {
            f(-1 - node.second_child);
            if (node.partner >= 0) f(node.partner);
            return;
        }
        for (const LeafLight* one = &scene_.leaf_lights[-2 - node.partner]; one->light >= 0; ++one) f(one->light);
    }

    std::uint32_t instance_of(std::int32_t light) const {
        return light < scene_.point_count ? kNoInstance : scene_.areas[light - scene_.point_count].instance;
    }

    /// Of all lights of a node together. The node's own bounds also hold the way of lights that move; what moves with
    /// one instance stays as large as it is.
    double size_m(std::int32_t at) const {
        const double swept = 2 * std::sqrt(static_cast<double>(scene_.light_nodes[at].squared_radius));
        std::int32_t leaf = at;
        while (scene_.light_nodes[leaf].second_child > 0) ++leaf;
        const std::uint32_t instance = instance_of(-1 - scene_.light_nodes[leaf].second_child);
        if (instance == kNoInstance || scene_.instances[instance].key_count == 0) return swept;
        BoundingBox box;
        bool is_one = true;
        for_lights(at, [&](std::int32_t light) {
            is_one &= instance_of(light) == instance;
            if (!is_one) return;
            const AreaLight& area = scene_.areas[light - scene_.point_count];
            for (const Vec3f corner : {area.corner, area.corner + area.edge_u, area.corner + area.edge_v})
                box.add(static_cast<Vec3d>(corner));
        });
        return is_one ? box.diagonal() : swept;
    }

    void look_at(std::int32_t at, std::int32_t parent) {
        const LightNode& node = scene_.light_nodes[at];
        const Footprint seen = footprint(node.middle);
        const double size = size_m(at);
        if (size >= seen.size() && node.second_child > 0) {
            look_at(at + 1, at);
            look_at(node.second_child, at);
            return;
        }
        LightGroup group{TracedLightKind::triangles, {}};
        double area = 0;  // as the lens sees it, m^2
        for_lights(at, [&](std::int32_t light) {
            if (light < scene_.point_count) {
                groups_.push_back({TracedLightKind::point, {light}});
                return;
            }
            const AreaLight& triangle = scene_.areas[light - scene_.point_count];
            if (!shines(triangle)) return;
            group.lights.push_back(light - scene_.point_count);
            const float cosine = dot(normalized(front_ - triangle.corner), triangle.normal);
            area += static_cast<double>(triangle.area *
                                        (triangle.is_two_sided ? std::fabs(cosine) : std::max(cosine, 0.0f)));
        });
        // A lamp that is longer than the footprint lies in several footprints, as the tube of a neon sign does.
        const double share = area / (seen.area() * std::max(1.0, size / seen.size()));
        if (share < kLargestShare && !group.lights.empty() && !(parent >= 0 && is_surface(parent, seen)))
            groups_.push_back(std::move(group));
    }

    /// True if the emitters of a node larger than a footprint are parts of one surface in focus.
    bool is_surface(std::int32_t at, const Footprint& seen) const {
        if (seen.blur > seen.pixel) return false;
        double area = 0;
        for_lights(at, [&](std::int32_t light) {
            if (light < scene_.point_count) return;
            const AreaLight& triangle = scene_.areas[light - scene_.point_count];
            if (shines(triangle)) area += static_cast<double>(triangle.area);
        });
        return area > kSurfaceShare * std::numbers::pi / 4 * size_m(at) * seen.size();
    }

    const SceneView& scene_;
    const CameraView& camera_;
    Vec3f front_;
    std::vector<LightGroup> groups_;
};

}  // namespace

std::vector<LightGroup> light_groups(const SceneView& scene, const CameraView& camera) {
    return Grouping(scene, camera).all();
}

}  // namespace realcam
