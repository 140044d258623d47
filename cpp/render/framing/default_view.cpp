#include "default_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "../../optics/lens/focus.hpp"
#include "first_hit.hpp"
#include "subject.hpp"

namespace realcam {

double pupil_to_film_m(const LensSystem& lens) {
    const double pupil = nominal_first_order(lens).entrance_pupil_position;
    return (lens.film_position() - (std::isfinite(pupil) ? pupil : 0.0)) / 1000;
}

namespace {

/// Returns the extent of a box along a unit vector that is nearly parallel to one of its axes.
double extent(const BoundingBox& box, Vec3d direction) {
    const Vec3d size = box.size();
    return std::fabs(direction.x) * size.x + std::fabs(direction.y) * size.y + std::fabs(direction.z) * size.z;
}

/// Returns the distance from the entrance pupil to `target`, m, at which the boxes of all parts fill nine tenths of the
/// picture or, for an open room, at which its open side fills the picture. The pose gives the direction. The field of
/// view is taken as at most 90 degrees: to fill the picture of a fisheye, the camera would have to stand inside the
/// scene. All corners of the boxes lie in front of the lens.
double filling_distance(const Subject& subject, const Camera& camera, Vec3d target, bool is_open_room) {
    constexpr double kFilledFraction = 0.9;
    // Tangent of half the field of view. The axis points at the target: on a shifted film, the narrower side decides.
    const auto tangent = [&](double side_mm, double shift_mm) {
        const double half_mm = std::max(0.5 * side_mm - std::fabs(shift_mm), 0.1 * side_mm);
        const double angle = widest_field_angle(camera.lens, half_mm);
        return angle > 0 && angle < std::numbers::pi / 4 ? std::tan(angle) : 1.0;
    };
    const Film& film = camera.film;
    const double tan_x = tangent(film.width_mm, film.shift_mm.x), tan_y = tangent(film.height_mm, film.shift_mm.y);
    const auto axes = camera_detail::axes_of(camera.pose);
    // Least distance of a corner: also for a scene without breadth, such as a plane seen edge-on. The entrance pupil
    // lies `pupil` mm behind the front vertex, which gets a margin of 20%.
    const double pupil = nominal_first_order(camera.lens).entrance_pupil_position;
    const double least = std::max(0.1 * subject.box.diagonal(), std::isfinite(pupil) ? 0.0012 * pupil : 0.0);
    double distance = 0;
    for (const BoundingBox& part : subject.part_boxes)
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3d p = part.corner(corner) - target;
            const double by_width = std::fabs(dot(p, axes.right)) / tan_x,
                         by_height = std::fabs(dot(p, axes.up)) / tan_y;
            const double required =
                is_open_room ? std::min(by_width, by_height) : std::max(by_width, by_height) / kFilledFraction;
            distance = std::max(distance, dot(p, axes.backward) + std::max(required, least));
        }
    return distance;
}

/// Returns the camera of the scene whose view is used, or null if a view is to be chosen. Throws InputError if the
/// scene has no camera of the requested name, if that camera is orthographic, or if a position is requested, too.
const SceneCamera* chosen_camera(const Assembly& assembly, const ViewRequest& request) {
    const bool is_placed = request.position_m || request.look_at_m;
    if (request.camera.empty()) {
        for (const SceneCamera& camera : assembly.cameras)
            if (camera.has_pose() && !is_placed) return &camera;
        return nullptr;
    }
    std::string names;
    for (const SceneCamera& camera : assembly.cameras) {
        names += (names.empty() ? "\"" : ", \"") + camera.name + '"';
        if (camera.name != request.camera) continue;
        if (is_placed) throw InputError("a camera of the scene and a position or look-at exclude each other");
        if (camera.has_pose()) return &camera;
        throw InputError("the scene's camera \"" + camera.name + "\" is orthographic; expected a perspective camera");
    }
    if (request.camera == ViewRequest::kNoCamera) return nullptr;
    throw InputError("the scene has no camera \"" + request.camera + "\"; " +
                     (names.empty() ? "it has none" : "it has " + names));
}

/// Returns the pose that puts the entrance pupil of a lens at the position of a scene's camera.
Pose pose_of(const Affine<double>& scene_from_camera, const LensSystem& lens) {
    const Vec3d backward = normalized(scene_from_camera.z);
    const Vec3d position = scene_from_camera.origin + pupil_to_film_m(lens) * backward;
    return {position, position - backward, normalized(scene_from_camera.y)};
}

/// Places and focuses a camera whose pose depends on its lens: `pose_of_lens(lens)` returns the pose. Focuses at
/// `focus_distance_m` (from the film) or, without it, on the first surface on the axis beyond the lens or, if there is
/// none, on the plane through the centre of the subject. Throws InputError if the lens cannot focus there.
template <class PoseOfLens>
void pose_and_focus(Camera& camera, const Assembly& assembly, const Subject& subject,
                    std::optional<double> focus_distance_m, PoseOfLens&& pose_of_lens) {
    const LensSystem lens = camera.lens;
    camera.pose = pose_of_lens(lens);
    // The pose depends on the focus, and the focus on the pose, so both are iterated.
    for (int i = 0; i < 4; ++i) {
        validate(camera);
        const Vec3d position = camera.pose.position_m, forward = normalized(camera.pose.look_at_m - position);
        const double lens_end_m = camera.lens.film_position() / 1000;
        double distance_m = focus_distance_m.value_or(first_hit(assembly, position, forward, lens_end_m));
        if (!focus_distance_m && !std::isfinite(distance_m)) {
            const double middle_m = dot(forward, subject.box.middle() - position);
            if (middle_m > lens_end_m) distance_m = middle_m;
        }
        camera.lens = focused(lens, 1000 * distance_m);
        camera.pose = pose_of_lens(camera.lens);
        if (camera.pose.position_m == position) return;
    }
}

/// Chooses a view of the subject by the rules in default_view.hpp, and sets pose and focus of the camera.
void choose_view(Camera& camera, const Assembly& assembly, const Subject& subject, const ViewRequest& request) {
    const BoundingBox& box = subject.box;
    Vec3d front = std::fabs(request.up.z) > 0.99 * length(request.up) ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
    camera.pose = {front, {0, 0, 0}, request.up};
    validate(camera);
    const Vec3d up = normalized(request.up - dot(request.up, front) * front);
    const Vec3d right = cross(up, front);
    for (const Vec3d side : {front, right, -right, -front})
        if (!subject.has_wall(side)) {
            front = side;
            break;
        }
    const Vec3d aside = cross(up, front);
    const double width = extent(box, aside), height = extent(box, up), depth = extent(box, front);
    const bool is_closed = subject.is_room() && subject.has_wall(front), is_open = subject.is_room() && !is_closed;
    const bool shows_content = is_closed && !subject.content.empty();
    const Vec3d target = request.look_at_m.value_or((shows_content ? subject.content : box).middle());
    Vec3d backward = front;
    double limit = kInfinity, longest = 0;  // largest distance of the camera from the target, m; longest view in a room
    if (is_closed) {
        // Camera positions near the corners, as fractions of the room's extent from its centre.
        constexpr double kAside = 0.42, kAbove = 0.1;
        for (const double forth : {1, -1})
            for (const double sideways : {1, -1}) {
                const Vec3d view = box.middle() + kAside * (forth * depth * front + sideways * width * aside) +
                                   kAbove * height * up - target;
                const double visible = std::min(first_hit(assembly, target + view, normalized(-view)), length(view));
                if (!(visible > 1.001 * longest)) continue;
                longest = visible;
                backward = normalized(view);
                limit = length(view);
            }
    } else {
        if (!is_open) {
            // The camera moves to the right (1) or the left (-1), but not to a side where a wall would hide the
            // subject.
            const double side = !subject.has_wall(aside) ? 1 : subject.has_wall(-aside) ? 0 : -1;
            const double azimuth = side * 0.5 * std::atan2(depth, width), elevation = 0.5 * std::atan2(depth, height);
            backward = std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * aside) +
                       std::sin(elevation) * up;
        }
        // The camera stays in front of the first surface behind it, so that nothing hides the subject.
        double subject_edge = 0;
        for (int corner = 0; corner < 8; ++corner)
            subject_edge = std::max(subject_edge, dot(box.corner(corner) - target, backward));
        limit = 0.99 * first_hit(assembly, target, backward, subject_edge + 1e-6 * box.diagonal());
    }
    camera.pose = {target + backward, target, request.up};
    validate(camera);
    const Camera unplaced = camera;
    double distance = 0, least = 0;
    const auto pose_of_lens = [&](const LensSystem& lens) {
        camera.lens = lens;
        distance = std::max(least, std::min(limit, filling_distance(subject, camera, target, is_open)));
        return Pose{target + (distance + pupil_to_film_m(lens)) * backward, target, request.up};
    };
    for (int i = 0;; ++i) {
        try {
            pose_and_focus(camera, assembly, subject, request.focus_distance_m, pose_of_lens);
            return;
        } catch (const InputError&) {
            constexpr int kMaxSteps = 99;
            if (request.focus_distance_m || i == kMaxSteps) throw;
            least = 1.2 * distance;
            limit = kInfinity;  // the lens cannot focus within the room, which is then viewed from outside
            camera = unplaced;
        }
    }
}

}  // namespace

void add_daylight(Scene& scene, const Pose& pose) {
    const auto axes = camera_detail::axes_of(pose);
    const Vec3d to_sun = normalized(-0.5 * axes.right + 0.8 * axes.up + 0.6 * axes.backward);
    scene.suns.push_back({static_cast<Vec3f>(-to_sun), {84e3f, 80e3f, 68e3f}});
    scene.environment = {};
    scene.environment.constant = {4450, 5040, 6250};
}

const SceneCamera* set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request) {
    validate(assembly);
    camera.motion.clear();
    const SceneCamera* from = chosen_camera(assembly, request);
    const Assembly still = frozen_at(assembly, camera.shutter.opens_s);
    const Subject subject(still, normalized(request.up));
    if (from) {
        const Affine<double> transform = from->transform_at(camera.shutter.opens_s);
        try {
            pose_and_focus(camera, still, subject, request.focus_distance_m,
                           [&](const LensSystem& lens) { return pose_of(transform, lens); });
        } catch (const InputError& error) {
            throw InputError(std::string(error.what()) + " (at the position of the scene's camera \"" + from->name +
                             "\"; use camera \"none\" for a view that is chosen)");
        }
        std::vector<PoseKey> keys;
        for (std::size_t k = 0; from->motion && k < from->motion->times_s.size(); ++k)
            keys.push_back({from->motion->times_s[k], pose_of(from->motion->transforms[k], camera.lens)});
        if (from->motion) set_motion(camera, std::move(keys));
    } else if (request.position_m) {
        const Pose pose = {*request.position_m, request.look_at_m.value_or(subject.box.middle()), request.up};
        pose_and_focus(camera, still, subject, request.focus_distance_m, [&](const LensSystem&) { return pose; });
    } else {
        choose_view(camera, still, subject, request);
    }
    return from;
}

}  // namespace realcam
