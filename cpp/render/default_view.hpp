#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "../camera/camera.hpp"
#include "../camera/field_of_view.hpp"
#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// What the user says of the camera's place; the rest is chosen.
struct ViewRequest {
    std::optional<Vec3d> position_m, look_at_m;
    Vec3d up = {0, 1, 0};
    std::optional<double> focus_distance_m;  ///< object plane to film; infinity allowed
};

/// Distance from the film to the first surface on the camera's axis, metres; infinite where there is none. `nearest_m`:
/// where the lens ends. Asks every triangle: once for a picture, that costs less than a hierarchy.
inline double distance_on_axis(const Assembly& assembly, const Pose& pose, double nearest_m) {
    const Vec3d forward = normalized(pose.look_at_m - pose.position_m);
    double found = kInfinity;
    const auto look_at = [&](const Scene& scene, const InverseAffine<double>& into) {
        const Vec3d origin = into.point(pose.position_m), direction = into.direction(forward);
        for (const Triangle& t : scene.triangles) {
            // Moeller and Trumbore 1997.
            const Vec3d a = scene.positions_m[t.vertices[0]] - origin;
            const Vec3d u = scene.positions_m[t.vertices[1]] - origin - a;
            const Vec3d v = scene.positions_m[t.vertices[2]] - origin - a;
            const Vec3d p = cross(direction, v), q = cross(u, a);
            const double determinant = dot(u, p);
            const double first = -dot(a, p) / determinant, second = dot(direction, q) / determinant;
            if (!(first >= 0 && second >= 0 && first + second <= 1)) continue;
            const double distance = dot(v, q) / determinant;
            if (distance > nearest_m && distance < found) found = distance;
        }
    };
    look_at(*assembly.static_geometry, Affine<double>().inverse());
    for (const Instance& instance : assembly.instances) look_at(*instance.object, instance.scene_from_object.inverse());
    return found;
}

namespace default_view_detail {

/// The share of the film that the scene fills.
constexpr double kFilledShare = 0.9;

/// Autofocus: the first surface on the axis; where there is none, the plane through the middle of the scene.
inline double autofocus_m(const Assembly& assembly, const BoundingBox& box, const Camera& camera) {
    const double lens_end = camera.lens.film_position() / 1000;
    const double hit = distance_on_axis(assembly, camera.pose, lens_end);
    if (std::isfinite(hit)) return hit;
    const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
    const double middle = dot(forward, box.middle() - camera.pose.position_m);
    return middle > lens_end ? middle : kInfinity;
}

/// Entrance pupil to `target` at which every corner of the box lies in the picture. The field counts up to 90 degrees:
/// to fill the picture of a fisheye, the camera would have to stand inside the scene. No corner lies in the lens.
inline double filling_distance(const BoundingBox& box, const Camera& camera, Vec3d target) {
    using camera_detail::axes_of;
    const auto tangent = [&](double half_film_mm) {
        const double angle = widest_field_angle(camera.lens, half_film_mm);
        return kFilledShare * (angle > 0 && angle < std::numbers::pi / 4 ? std::tan(angle) : 1.0);
    };
    const double tan_x = tangent(0.5 * camera.film.width_mm), tan_y = tangent(0.5 * camera.film.height_mm);
    const auto axes = axes_of(camera.pose);
    // Also keeps a scene without breadth, such as a plane seen edge on, in front of the camera.
    const double pupil = first_order(camera.lens, camera.lens.wavelength_nm).entrance_pupil_position;
    const double least = std::max(0.1 * length(box.high - box.low), std::isfinite(pupil) ? 0.0012 * pupil : 0.0);
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = Vec3d{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                              corner & 4 ? box.high.z : box.low.z} -
                        target;
        const double aside = std::max(std::fabs(dot(p, axes.right)) / tan_x, std::fabs(dot(p, axes.up)) / tan_y);
        distance = std::max(distance, dot(p, axes.backward) + std::max(aside, least));
    }
    return distance;
}

/// `pose.position_m` for an entrance pupil that far from look_at_m.
inline void stand_back(Camera& camera, Vec3d backward, double pupil_to_target_m) {
    const LensSystem& lens = camera.lens;
    const double pupil = first_order(lens, lens.wavelength_nm).entrance_pupil_position;
    const double film_to_pupil_m = (lens.film_position() - (std::isfinite(pupil) ? pupil : 0.0)) / 1000;
    camera.pose.position_m = camera.pose.look_at_m + (pupil_to_target_m + film_to_pupil_m) * backward;
}

}  // namespace default_view_detail

/// Sets camera.pose and focuses camera.lens: as asked for, and otherwise so.
/// - look_at: the middle of the scene's bounding box.
/// - position: in front of look_at along +z (along -y where up is the z axis), so far away that the bounding box fills
///   nine tenths of the film.
/// - focus: the first surface on the camera's axis, or the depth of the scene's middle where the axis meets nothing. A
///   camera whose place was chosen steps back where its lens cannot focus that near.
/// Throws InputError where the lens cannot focus as asked for, and for a scene without triangles.
inline void set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request) {
    using namespace default_view_detail;
    validate(assembly);
    const BoundingBox box = bounding_box(assembly);
    const LensSystem lens = camera.lens;
    camera.pose.up = request.up;
    camera.pose.look_at_m = request.look_at_m.value_or(box.middle());
    const auto focus = [&] {
        const double distance =
            request.focus_distance_m ? *request.focus_distance_m : autofocus_m(assembly, box, camera);
        camera.lens = focused(lens, 1000 * distance);
    };
    if (request.position_m) {
        camera.pose.position_m = *request.position_m;
        validate(camera);
        return focus();
    }
    const bool z_is_up = std::fabs(request.up.z) > 0.99 * length(request.up);
    const Vec3d backward = z_is_up ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
    camera.pose.position_m = camera.pose.look_at_m + backward;
    validate(camera);
    if (request.focus_distance_m) focus();
    // The field narrows as the lens focuses nearer, and the lens focuses nearer as the field widens.
    double least = 0;
    for (int i = 0, settled = 0; i < 100 && settled < 4; ++i) {
        const double distance = std::max(least, filling_distance(box, camera, camera.pose.look_at_m));
        stand_back(camera, backward, distance);
        if (request.focus_distance_m) {
            ++settled;
            continue;
        }
        try {
            focus();
            ++settled;
        } catch (const InputError&) {
            if (i == 99) throw;
            least = 1.2 * distance;
            settled = 0;
        }
    }
}

}  // namespace REALCAM_NAMESPACE
