#include "light_groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../../scene/geometry/bounding_box.hpp"
#include "../../scene/lights/light.hpp"

namespace realcam {
namespace {

/// Largest fraction of a pixel's samples that hit a traced lamp. If more hit it, samples of pixels have less noise than
/// samples from the lamp would.
constexpr double kMaxFilledFraction = 0.8;
/// Largest difference in depth, over the radius of a pixel's footprint, at which two emitters count as one. 4 = tan(76
/// degrees): surfaces that are tilted by up to this angle are one emitter, and a wall behind a lamp is not part of it.
constexpr double kMaxDepth = 4;

/// Region that the samples of one pixel cover at a distance: the blur disc, swept over the pixel. In metres.
struct PixelFootprint {
    double blur;  ///< radius of the blur disc
    double pixel;  ///< side of a square with the area of the pixel

    /// Area of the disc swept over the square (Minkowski sum).
    double area() const { return std::numbers::pi * blur * blur + 4 * blur * pixel + pixel * pixel; }
    /// Largest size of a group of lights, which is measured by the diagonal of its bounding box: up to 1.73 times the
    /// width of a round lamp.
    double size() const { return 2 * (blur + pixel); }
};

/// Returns the signed area of the part of the triangle with the corners 0, a and b that lies in the circle of a radius
/// about 0. a and b are perpendicular to the unit vector `axis`; the area is positive if the angle from a to b about it
/// is counterclockwise.
double area_in_circle(Vec3d a, Vec3d b, Vec3d axis, double radius) {
    const auto double_area = [&](Vec3d from, Vec3d to) { return dot(cross(from, to), axis); };
    const auto sector = [&](Vec3d from, Vec3d to) {
        return 0.5 * radius * radius * std::atan2(double_area(from, to), dot(from, to));
    };
    const Vec3d offset = b - a;
    const double squared_length = dot(offset, offset), along = dot(a, offset),
                 discriminant = along * along - squared_length * (dot(a, a) - radius * radius);
    if (!(discriminant > 0)) return sector(a, b);
    const double root = std::sqrt(discriminant);
    const Vec3d enters = a + std::clamp((-along - root) / squared_length, 0.0, 1.0) * offset,
                leaves = a + std::clamp((-along + root) / squared_length, 0.0, 1.0) * offset;
    return sector(a, enters) + 0.5 * double_area(enters, leaves) + sector(leaves, b);
}

/// Cylinder about the direction to the lens through a point, with the cross-section of a pixel's footprint there.
/// Emitters inside it are hit by the pixel's samples.
struct FootprintCylinder {
    Vec3d middle, axis;  ///< centre, m; unit vector
    double radius;

    double area() const { return std::numbers::pi * radius * radius; }
    /// Returns true if a sphere about a point may intersect the cylinder.
    bool may_intersect(Vec3d point, double sphere_radius) const {
        const Vec3d offset = point - middle;
        const double along = dot(offset, axis), across = length(offset - along * axis);
        return std::fabs(along) < kMaxDepth * radius + sphere_radius && across < radius + sphere_radius;
    }
    /// Area of the cylinder's cross-section that the light covers, projected along the axis.
    double covered_area(const AreaLight& light) const {
        const Vec3d corner = static_cast<Vec3d>(light.corner) - middle;
        Vec3d corners[] = {corner, corner + static_cast<Vec3d>(light.edge_u),
                           corner + static_cast<Vec3d>(light.edge_v)};
        double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
        for (Vec3d& p : corners) {
            const double along = dot(p, axis);
            nearest = std::min(nearest, along);
            farthest = std::max(farthest, along);
            p = p - along * axis;
        }
        if (nearest > kMaxDepth * radius || farthest < -kMaxDepth * radius) return 0;
        double area = 0;
        for (int i = 0; i < 3; ++i) area += area_in_circle(corners[i], corners[(i + 1) % 3], axis, radius);
        return std::fabs(area);
    }
};

/// Descends the light tree and divides its lights into groups.
class Grouping {
public:
    Grouping(const SceneView& scene, const CameraView& camera)
        : scene_(scene), camera_(camera), front_(front_vertex(camera, camera.front_vertex_m)) {}

    std::vector<LightGroup> groups() && {
        if (scene_.light_node_count > 0) add_node(0);
        for (std::int32_t i = 0; i < scene_.sun_count; ++i) groups_.push_back({TracedLightKind::sun, {i}});
        return std::move(groups_);
    }

private:
    /// Footprint of the pixel at the film's centre, at the distance of a point.
    PixelFootprint footprint(Vec3f point) const {
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

    /// Returns true if light may leave the triangle towards the lens. A moving triangle or camera is not tested.
    bool shines(const AreaLight& light) const {
        if (light.is_two_sided || light.instance != kNoInstance || camera_.key_count > 0) return true;
        const double reach_m = 2e-3 * std::fabs(static_cast<double>(camera_.circle.rim));
        return static_cast<double>(dot(front_ - light.corner, light.normal)) > -reach_m;
    }

    /// Calls f(index) for all lights of a node. Indices count the point lights first, and then the area lights.
    template <class F>
    void for_lights(std::int32_t node_index, F&& f) const {
        const LightNode& node = scene_.light_nodes[node_index];
        if (node.second_child > 0) {
            for_lights(node_index + 1, f);
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

    /// Returns the instance to which a light belongs. `light`: index as in for_lights.
    std::uint32_t instance_of(std::int32_t light) const {
        return light < scene_.point_count ? kNoInstance : scene_.areas[light - scene_.point_count].instance;
    }

    /// Returns the size of all lights of a node together, m. The node's own bounds enclose the paths of moving lights;
    /// for lights that all move with one instance, the size without the motion is computed instead.
    double size_m(std::int32_t node_index) const {
        const double swept = 2 * std::sqrt(static_cast<double>(scene_.light_nodes[node_index].squared_radius));
        std::int32_t leaf = node_index;
        while (scene_.light_nodes[leaf].second_child > 0) ++leaf;
        const std::uint32_t instance = instance_of(-1 - scene_.light_nodes[leaf].second_child);
        if (instance == kNoInstance || scene_.instances[instance].key_count == 0) return swept;
        BoundingBox box;
        bool is_one = true;
        for_lights(node_index, [&](std::int32_t light) {
            is_one &= instance_of(light) == instance;
            if (!is_one) return;
            const AreaLight& area = scene_.areas[light - scene_.point_count];
            for (const Vec3f corner : {area.corner, area.corner + area.edge_u, area.corner + area.edge_v})
                box.add(static_cast<Vec3d>(corner));
        });
        return is_one ? box.diagonal() : swept;
    }

    /// Adds the lights of a node as one group if they are smaller than a pixel's footprint; otherwise those of its
    /// children separately. Omits a group that fills too much of the footprint.
    void add_node(std::int32_t node_index) {
        const LightNode& node = scene_.light_nodes[node_index];
        const PixelFootprint footprint_there = footprint(node.middle);
        const double size = size_m(node_index);
        if (size >= footprint_there.size() && node.second_child > 0) {
            add_node(node_index + 1);
            add_node(node.second_child);
            return;
        }
        LightGroup group{TracedLightKind::triangles, {}};
        for_lights(node_index, [&](std::int32_t light) {
            if (light < scene_.point_count)
                groups_.push_back({TracedLightKind::point, {light}});
            else if (shines(scene_.areas[light - scene_.point_count]))
                group.lights.push_back(light - scene_.point_count);
        });
        if (group.lights.empty()) return;
        group.filled_fraction = filled_fraction_of(group);
        if (group.filled_fraction < kMaxFilledFraction) groups_.push_back(std::move(group));
    }

    /// Computes LightGroup::filled_fraction, up to about kMaxFilledFraction, beyond which it makes no difference.
    double filled_fraction_of(const LightGroup& group) const {
        double area = 0, brightness = 0;
        Vec3d middle = {};
        for (const std::int32_t light_index : group.lights) {
            const AreaLight& light = scene_.areas[light_index];
            const double weight = static_cast<double>(light.area);
            area += weight;
            brightness += weight * static_cast<double>(luminance(light.radiance));
            middle = middle + weight * middle_of(light);
        }
        middle = (1 / area) * middle;
        brightness /= area;
        const auto distance = [&](std::int32_t light_index) {
            return length(middle_of(scene_.areas[light_index]) - middle);
        };
        const std::int32_t central =
            *std::min_element(group.lights.begin(), group.lights.end(),
                              [&](std::int32_t a, std::int32_t b) { return distance(a) < distance(b); });

        const Vec3d centre = middle_of(scene_.areas[central]);
        const FootprintCylinder cylinder = {centre, normalized(static_cast<Vec3d>(front_) - centre),
                                            std::sqrt(footprint(static_cast<Vec3f>(centre)).area() / std::numbers::pi)};
        const double all = kMaxFilledFraction * cylinder.area();
        double left = all;
        subtract_lights(0, cylinder, brightness, left);
        return (all - left) / cylinder.area();
    }

    /// Centroid of the triangle.
    static Vec3d middle_of(const AreaLight& light) {
        return static_cast<Vec3d>(light.corner) +
               1.0 / 3 * (static_cast<Vec3d>(light.edge_u) + static_cast<Vec3d>(light.edge_v));
    }

    /// Subtracts the area that a node's emitters cover from `left`, until nothing is left. Darker emitters count in
    /// proportion to their brightness, because samples that hit them find less light.
    void subtract_lights(std::int32_t node_index, const FootprintCylinder& cylinder, double brightness,
                         double& left) const {
        const LightNode& node = scene_.light_nodes[node_index];
        if (left <= 0 || !cylinder.may_intersect(static_cast<Vec3d>(node.middle),
                                                 std::sqrt(static_cast<double>(node.squared_radius))))
            return;
        if (node.second_child > 0) {
            subtract_lights(node_index + 1, cylinder, brightness, left);
            subtract_lights(node.second_child, cylinder, brightness, left);
            return;
        }
        for_lights(node_index, [&](std::int32_t light_index) {
            if (light_index < scene_.point_count) return;
            const AreaLight& light = scene_.areas[light_index - scene_.point_count];
            const double share = static_cast<double>(luminance(light.radiance)) / brightness;
            if (shines(light)) left -= std::min(1.0, share) * cylinder.covered_area(light);
        });
    }

    const SceneView& scene_;
    const CameraView& camera_;
    Vec3f front_;
    std::vector<LightGroup> groups_;
};

}  // namespace

std::vector<LightGroup> light_groups(const SceneView& scene, const CameraView& camera) {
    return Grouping(scene, camera).groups();
}

}  // namespace realcam
