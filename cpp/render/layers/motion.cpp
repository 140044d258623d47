#include "motion.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "../../camera/projection/picture_map.hpp"
#include "../../scene/geometry/surface_point.hpp"

namespace realcam {

namespace {

/// Positions of surfaces in the camera's frame at three times of the exposure of a row of pixels: its begin, its middle
/// and its end.
class RowMotion {
public:
    /// Index of a time in `times_`.
    enum When : std::size_t { begin, middle, end };

    RowMotion(const Assembly& scene, const Camera& camera, int row) : scene_(scene) {
        const double opens =
            camera.shutter.opens_s + camera.shutter.readout_time_s * row / static_cast<double>(camera.film.height);
        times_ = {opens, opens + 0.5 * camera.exposure_time_s, opens + camera.exposure_time_s};
        for (std::size_t k = 0; k < 3; ++k)
            from_scene_[k] = camera_detail::scene_from_camera(pose_at(camera, times_[k])).inverse();
    }

    /// Returns the position in the camera's frame at `when` of a surface point that lies at `point_m` in the scene at
    /// mid-exposure. `instance`: to which the point belongs, or kNoInstance.
    Vec3d point(Vec3d point_m, std::uint32_t instance, When when) {
        return from_scene_[when].point(moved(point_m, instance, when));
    }
    /// Converts a direction from the scene to the camera's frame at `when`.
    Vec3d direction(Vec3d direction, When when) const { return from_scene_[when].direction(direction); }

private:
    /// Returns the position in the scene at `when` of that surface point.
    Vec3d moved(Vec3d point_m, std::uint32_t instance, When when) {
        if (instance == kNoInstance || !scene_.instances[instance].motion) return point_m;
        const auto [known, is_new] = transforms_.try_emplace(instance);
        if (is_new)
            for (std::size_t k = 0; k < 3; ++k) known->second[k] = scene_.instances[instance].transform_at(times_[k]);
        return known->second[when].point(known->second[middle].inverse().point(point_m));
    }

    const Assembly& scene_;
    std::array<double, 3> times_;
    std::array<InverseAffine<double>, 3> from_scene_;
    std::map<std::uint32_t, std::array<Affine<double>, 3>> transforms_;  ///< scene from object, of moving instances
};

}  // namespace

LayerImage motion_vectors(const std::vector<PixelCentreSurface>& film, const Assembly& scene, const Camera& camera,
                          const CameraView& placed_camera, Vec3d origin_m) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    LayerImage image{Layer::motion, std::vector<float>(2 * film.size()), {}};
    const bool anything_moves = scene.moves() || camera.moves();
    std::optional<PictureMap> map;
    if (anything_moves) map.emplace(placed_camera);
    const auto width = static_cast<std::size_t>(camera.film.width);
    std::optional<RowMotion> motion;  // one for all rows if they are exposed together
    for (std::size_t row = 0; row * width < film.size(); ++row) {
        if (!motion || camera.shutter.readout_time_s > 0) motion.emplace(scene, camera, static_cast<int>(row));
        for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
            const PixelCentreSurface& surface = film[i];
            // A blocked pixel is one whose centre ray does not pass the lens.
            const bool is_surface = surface.triangle != kNoTriangle, is_blocked = std::isnan(surface.depth);
            const bool may_move = camera.moves() || (is_surface && surface.instance != kNoInstance &&
                                                     scene.instances[surface.instance].motion);
            if (!is_blocked && !(anything_moves && may_move)) continue;
            const Vec3d point_m = static_cast<Vec3d>(surface.position);
            const auto pixel_at = [&](RowMotion::When when) {
                return is_surface ? map->pixel_of(motion->point(point_m + origin_m, surface.instance, when), false)
                                  : map->pixel_of(motion->direction(point_m, when), true);
            };
            std::optional<Vec2<double>> from, to;
            if (!is_blocked) from = pixel_at(RowMotion::begin), to = pixel_at(RowMotion::end);
            const bool is_known = from && to;
            image.values[2 * i] = is_known ? static_cast<float>(to->x - from->x) : kNone;
            image.values[2 * i + 1] = is_known ? static_cast<float>(to->y - from->y) : kNone;
        }
    }
    return image;
}

std::optional<SceneAndCamera> without_disabled_motion(const Assembly& scene, const Camera& camera,
                                                      const EffectChoice& effects) {
    if (effects.motion_blur && effects.rolling_shutter) return std::nullopt;
    SceneAndCamera changed{scene, camera};
    Shutter& shutter = changed.camera.shutter;
    if (!effects.rolling_shutter) shutter.readout_time_s = 0;
    if (effects.motion_blur) return changed;
    if (shutter.readout_time_s > 0) {
        shutter.blurs = false;
        return changed;
    }
    // All rows are exposed at one instant, at which the scene stands still, so that the kernels without motion suffice.
    const double middle_s = shutter.opens_s + 0.5 * camera.exposure_time_s;
    changed.camera.pose = pose_at(camera, middle_s);
    changed.camera.motion.clear();
    changed.scene = frozen_at(scene, middle_s);
    return changed;
}

}  // namespace realcam
