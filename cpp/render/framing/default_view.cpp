#include "default_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "../../optics/lens/focus.hpp"
#include "axis_crossings.hpp"
#include "subject.hpp"

namespace realcam {

namespace {

/// Focuses on the first surface on the axis beyond the lens or, if nothing is there, on the plane through the centre of
/// the subject. `film_m`: position of the film on the line of `axis`, which runs along the view direction. Throws
/// InputError if the lens cannot focus there.
void autofocus(Camera& camera, const LensSystem& lens, const AxisCrossings& axis, double film_m,
               const BoundingBox& subject) {
    const double lens_end_m = camera.lens.film_position() / 1000;
    double distance_m = axis.first_beyond(film_m + lens_end_m) - film_m;
    if (!std::isfinite(distance_m)) {
        const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
        const double middle_m = dot(forward, subject.middle() - camera.pose.position_m);
        distance_m = middle_m > lens_end_m ? middle_m : kInfinity;
    }
    camera.lens = focused(lens, 1000 * distance_m);
}

/// Distance from the entrance pupil to the film along the axis.
double film_to_pupil_m(const LensSystem& lens) {
    const double pupil = nominal_first_order(lens).entrance_pupil_position;
    return (lens.film_position() - (std::isfinite(pupil) ? pupil : 0.0)) / 1000;
}

/// The direction that the front of a scene faces: +z as in glTF, or -y if z is up.
Vec3d front_of(Vec3d up) {
    return std::fabs(up.z) > 0.99 * length(up) ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
}

/// Axes of an automatically chosen view, unit vectors.
struct ViewAxes {
    Vec3d front, right, up;  ///< front: from the subject to the camera, horizontal

    ViewAxes(const Subject& subject, Vec3d up_wanted) {
        front = front_of(up_wanted);
        up = normalized(up_wanted - dot(up_wanted, front) * front);
        right = cross(up, front);
        for (const Vec3d side : {front, right, -right, -front})
            if (!has_wall(subject, side)) {
                front = side;
                break;
            }
        right = cross(up, front);
    }

    /// Returns true if the subject's side in this direction is a wall. The direction is nearly along an axis.
    static bool has_wall(const Subject& subject, Vec3d direction) {
        const auto along = coordinates(direction);
        const auto largest = std::ranges::max_element(along, {}, [](double c) { return std::fabs(c); });
        return subject.has_wall[static_cast<std::size_t>(2 * (largest - along.begin()) + (*largest > 0))];
    }

    static double extent(const BoundingBox& box, Vec3d direction) {
        const Vec3d size = box.size();
        return std::fabs(direction.x) * size.x + std::fabs(direction.y) * size.y + std::fabs(direction.z) * size.z;
    }
};

/// Direction from the subject to the camera. Its elevation is half of that of the line from the lower front edge to the
/// upper back edge: an upright picture is seen from in front, a floor from 45 degrees above. A room is viewed
/// horizontally.
Vec3d direction_to_camera(const Subject& subject, const ViewAxes& axes) {
    if (subject.is_room()) return axes.front;
    const double elevation = 0.5 * std::atan2(axes.extent(subject.box, axes.front), axes.extent(subject.box, axes.up));
    return std::cos(elevation) * axes.front + std::sin(elevation) * axes.up;
}

/// Distance from the entrance pupil to `target` at which every corner of the box lies in the picture or, for an open
/// room, at which its open side fills the picture. The field is limited to 90 degrees: to fill the picture of a
/// fisheye, the camera would have to stand inside the scene. No corner lies in the lens.
double filling_distance(const BoundingBox& box, const Camera& camera, Vec3d target, bool is_open_room) {
    constexpr double kFilledShare = 0.9;
    const auto tangent = [&](double half_film_mm) {
        const double angle = widest_field_angle(camera.lens, half_film_mm);
        return angle > 0 && angle < std::numbers::pi / 4 ? std::tan(angle) : 1.0;
    };
    // The axis points at the target: if the film is shifted, its narrower side decides.
    const auto half = [](double side, double shift) { return std::max(0.5 * side - std::fabs(shift), 0.1 * side); };
    const Film& film = camera.film;
    const double tan_x = tangent(half(film.width_mm, film.shift_mm.x)),
                 tan_y = tangent(half(film.height_mm, film.shift_mm.y));
    const auto axes = camera_detail::axes_of(camera.pose);
    // This also keeps a scene without breadth, such as a plane seen edge on, in front of the camera.
    const double pupil = nominal_first_order(camera.lens).entrance_pupil_position;
    const double least = std::max(0.1 * box.diagonal(), std::isfinite(pupil) ? 0.0012 * pupil : 0.0);
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = box.corner(corner) - target;
        const double by_width = std::fabs(dot(p, axes.right)) / tan_x, by_height = std::fabs(dot(p, axes.up)) / tan_y;
        const double wanted =
            is_open_room ? std::min(by_width, by_height) : std::max(by_width, by_height) / kFilledShare;
        distance = std::max(distance, dot(p, axes.backward) + std::max(wanted, least));
    }
    return distance;
}

/// Largest distance of the camera from its target at which no surface lies between camera and subject; infinite if
/// nothing is in front of the subject. `axis`: along the view direction, from the target.
double free_distance(const AxisCrossings& axis, const BoundingBox& subject, Vec3d target, Vec3d backward) {
    double edge = 1e-6 * subject.diagonal();
    for (int corner = 0; corner < 8; ++corner)
        edge = std::max(edge, 1e-6 * subject.diagonal() + dot(subject.corner(corner) - target, backward));
    double limit = kInfinity;
    for (const double forward : axis.distances_m())
        if (forward < -edge) limit = std::min(limit, -forward);
    return limit;
}

/// The scene's camera whose view is used; null: choose a view. Throws InputError if the scene has no camera of the
/// requested name.
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
        throw InputError("the scene's camera \"" + camera.name + "\" is orthographic, which no lens is");
    }
    if (request.camera == ViewRequest::kNoCamera) return nullptr;
    throw InputError("the scene has no camera \"" + request.camera + "\"; " +
                     (names.empty() ? "it has none" : "it has " + names));
}

/// Pose with the entrance pupil of the lens at the position of a scene's camera.
Pose pose_of(const Affine<double>& scene_from_camera, const LensSystem& lens) {
    const Vec3d backward = normalized(scene_from_camera.z);
    const Vec3d position = scene_from_camera.origin + film_to_pupil_m(lens) * backward;
    return {position, position - backward, normalized(scene_from_camera.y)};
}

/// Takes over the position, direction and motion of a camera of the scene.
void take_view(Camera& camera, const Assembly& assembly, const SceneCamera& from,
               const std::optional<double>& focus_distance_m) {
    const LensSystem lens = camera.lens;
    const Affine<double> transform = from.transform_at(camera.shutter.opens_s);
    if (focus_distance_m) {
        camera.lens = focused(lens, 1000 * *focus_distance_m);
        camera.pose = pose_of(transform, camera.lens);
        validate(camera);
    } else {
        const BoundingBox box = Subject(assembly).box;
        // The film position depends on the focus, and the focus on the film position, so both are iterated.
        for (int i = 0; i < 4; ++i) {
            camera.pose = pose_of(transform, camera.lens);
            validate(camera);
            const AxisCrossings axis(assembly, camera.pose.position_m, -normalized(transform.z));
            autofocus(camera, lens, axis, 0, box);
        }
        camera.pose = pose_of(transform, camera.lens);
    }
    if (!from.motion) return;
    std::vector<PoseKey> keys;
    for (std::size_t k = 0; k < from.motion->times_s.size(); ++k)
        keys.push_back({from.motion->times_s[k], pose_of(from.motion->transforms[k], camera.lens)});
    set_motion(camera, std::move(keys));
}

/// Places the camera in the corner of a closed room with the longest free view towards the target, a little above half
/// of the room's height. Throws InputError if the lens cannot focus there.
void stand_inside(Camera& camera, const Assembly& assembly, const BoundingBox& room, const ViewAxes& axes,
                  const std::optional<double>& focus_distance_m) {
    constexpr double kAside = 0.42, kAbove = 0.1;  // fractions of the room's extent, from its centre
    double longest = 0;
    for (const double forth : {1, -1})
        for (const double aside : {1, -1}) {
            const Vec3d from = room.middle() + kAside * forth * axes.extent(room, axes.front) * axes.front +
                               kAside * aside * axes.extent(room, axes.right) * axes.right +
                               kAbove * axes.extent(room, axes.up) * axes.up;
            const Vec3d view = camera.pose.look_at_m - from;
            const double seen = std::min(AxisCrossings(assembly, from, normalized(view)).first_beyond(0), length(view));
            if (!(seen > 1.001 * longest)) continue;
            longest = seen;
            camera.pose.position_m = from;
        }
    validate(camera);
    if (focus_distance_m) {
        camera.lens = focused(camera.lens, 1000 * *focus_distance_m);
        return;
    }
    const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
    const LensSystem lens = camera.lens;
    autofocus(camera, lens, AxisCrossings(assembly, camera.pose.position_m, forward), 0, room);
}

/// Places the camera at the distance at which the subject fills the picture, or nearer if another surface would be in
/// between. Steps back if the lens cannot focus that near.
void stand_outside(Camera& camera, const Assembly& assembly, const BoundingBox& subject, bool is_open_room,
                   Vec3d backward, const std::optional<double>& focus_distance_m) {
    const Vec3d target = camera.pose.look_at_m;
    camera.pose.position_m = target + backward;
    validate(camera);
    const LensSystem lens = camera.lens;
    const AxisCrossings axis(assembly, target, -backward);
    double limit = 0.99 * free_distance(axis, subject, target, backward);
    if (focus_distance_m) camera.lens = focused(lens, 1000 * *focus_distance_m);
    // The field of view and the focus depend on each other, so both are iterated.
    double least = 0;
    for (int i = 0, calm_steps = 0; i < 100 && calm_steps < 4; ++i) {
        const double distance =
            std::max(least, std::min(limit, filling_distance(subject, camera, target, is_open_room)));
        const double film_m = distance + film_to_pupil_m(camera.lens);
        camera.pose.position_m = target + film_m * backward;
        ++calm_steps;
        if (focus_distance_m) continue;
        try {
            autofocus(camera, lens, axis, -film_m, subject);
        } catch (const InputError&) {
            if (i == 99) throw;
            least = 1.2 * distance;
            limit = kInfinity;
            calm_steps = 0;
        }
    }
}

}  // namespace

const SceneCamera* set_view(Camera& camera, const Assembly& assembly, const ViewRequest& request) {
    validate(assembly);
    camera.motion.clear();
    if (const SceneCamera* from = chosen_camera(assembly, request)) {
        try {
            take_view(camera, standing_at(assembly, camera.shutter.opens_s), *from, request.focus_distance_m);
        } catch (const InputError& error) {
            throw InputError(std::string(error.what()) + " (in the place of the scene's camera \"" + from->name +
                             "\"; camera \"none\" takes another)");
        }
        return from;
    }
    if (assembly.moves()) return set_view(camera, standing_at(assembly, camera.shutter.opens_s), request);
    const Subject subject(assembly);
    camera.pose.up = request.up;
    if (request.position_m) {
        camera.pose.look_at_m = request.look_at_m.value_or(subject.box.middle());
        camera.pose.position_m = *request.position_m;
        validate(camera);
        if (request.focus_distance_m) {
            camera.lens = focused(camera.lens, 1000 * *request.focus_distance_m);
        } else {
            const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
            const LensSystem lens = camera.lens;
            autofocus(camera, lens, AxisCrossings(assembly, camera.pose.position_m, forward), 0, subject.box);
        }
        return nullptr;
    }
    camera.pose.look_at_m = request.look_at_m.value_or(subject.box.middle());
    camera.pose.position_m = camera.pose.look_at_m + front_of(request.up);
    validate(camera);
    const ViewAxes axes(subject, request.up);
    const bool is_closed = subject.is_room() && axes.has_wall(subject, axes.front);
    const BoundingBox& shown = is_closed && !subject.content.empty() ? subject.content : subject.box;
    camera.pose.look_at_m = request.look_at_m.value_or(shown.middle());
    if (is_closed) {
        Camera inside = camera;
        try {
            stand_inside(inside, assembly, subject.box, axes, request.focus_distance_m);
            camera = std::move(inside);
            return nullptr;
        } catch (const InputError&) {
            // The lens does not fit into the room, which is then seen from outside.
        }
    }
    stand_outside(camera, assembly, subject.box, subject.is_room() && !is_closed, direction_to_camera(subject, axes),
                  request.focus_distance_m);
    return nullptr;
}

void add_daylight(Scene& scene, const Pose& pose) {
    const auto axes = camera_detail::axes_of(pose);
    const Vec3d to_sun = normalized(-0.5 * axes.right + 0.8 * axes.up + 0.6 * axes.backward);
    scene.suns.push_back({static_cast<Vec3f>(-to_sun), {84e3f, 80e3f, 68e3f}});
    scene.environment = {};
    scene.environment.constant = {4450, 5040, 6250};
}

}  // namespace realcam
