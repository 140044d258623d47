#include "default_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "../optics/lens/focus.hpp"
#include "axis_crossings.hpp"
#include "room.hpp"

namespace realcam {

namespace {

/// The share of the film that the scene fills.
constexpr double kFilledShare = 0.9;

/// Autofocus: the first surface on the axis; where there is none, the plane through the middle of the scene.
/// `film_m`: where the film is on the line of the crossings, which run along the camera's view.
double autofocus_m(const AxisCrossings& axis, double film_m, const BoundingBox& box, const Camera& camera) {
    const double lens_end = camera.lens.film_position() / 1000;
    const double hit = axis.first_beyond(film_m + lens_end) - film_m;
    if (std::isfinite(hit)) return hit;
    const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
    const double middle = dot(forward, box.middle() - camera.pose.position_m);
    return middle > lens_end ? middle : kInfinity;
}

/// Entrance pupil to `target` at which every corner of the box lies in the picture. The field counts up to 90 degrees:
/// to fill the picture of a fisheye, the camera would have to stand inside the scene. No corner lies in the lens.
double filling_distance(const BoundingBox& box, const Camera& camera, Vec3d target) {
    using camera_detail::axes_of;
    const auto tangent = [&](double half_film_mm) {
        const double angle = widest_field_angle(camera.lens, half_film_mm);
        return kFilledShare * (angle > 0 && angle < std::numbers::pi / 4 ? std::tan(angle) : 1.0);
    };
    // The axis looks at the target: of a film that is shifted the narrower side counts, as far as there is one.
    const auto half = [](double side, double shift) { return std::max(0.5 * side - std::fabs(shift), 0.1 * side); };
    const Film& film = camera.film;
    const double tan_x = tangent(half(film.width_mm, film.shift_mm.x)),
                 tan_y = tangent(half(film.height_mm, film.shift_mm.y));
    const auto axes = axes_of(camera.pose);
    // This also keeps a scene without breadth, such as a plane seen edge on, in front of the camera.
    const double pupil = nominal_first_order(camera.lens).entrance_pupil_position;
    const double least = std::max(0.1 * box.diagonal(), std::isfinite(pupil) ? 0.0012 * pupil : 0.0);
    double distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p = box.corner(corner) - target;
        const double aside = std::max(std::fabs(dot(p, axes.right)) / tan_x, std::fabs(dot(p, axes.up)) / tan_y);
        distance = std::max(distance, dot(p, axes.backward) + std::max(aside, least));
    }
    return distance;
}

/// `pose.position_m` for an entrance pupil that far from look_at_m.
void stand_back(Camera& camera, Vec3d backward, double pupil_to_target_m) {
    const LensSystem& lens = camera.lens;
    const double pupil = nominal_first_order(lens).entrance_pupil_position;
    const double film_to_pupil_m = (lens.film_position() - (std::isfinite(pupil) ? pupil : 0.0)) / 1000;
    camera.pose.position_m = camera.pose.look_at_m + (pupil_to_target_m + film_to_pupil_m) * backward;
}

/// How far from its target the camera may stand, so that no surface is between it and its subject; infinite where there
/// is room. `axis`: along the camera's view, from the target.
double free_distance(const AxisCrossings& axis, const BoundingBox& subject, bool room, Vec3d target, Vec3d backward) {
    double edge = 1e-6 * subject.diagonal();
    for (int corner = 0; corner < 8; ++corner)
        edge = std::max(edge, 1e-6 * subject.diagonal() + dot(subject.corner(corner) - target, backward));
    double limit = kInfinity, last = -kInfinity, longest = 0;
    for (const double forward : axis.distances_m()) {
        const bool within = forward >= -edge;
        // What is in front of the subject is no part of it: a wall, or the sky's back.
        if (!room && !within) limit = std::min(limit, -forward);
        if (!room || !within) continue;
        // In a room the camera stands where its view is longest.
        if (last < 0 && std::isfinite(last) && forward - last > longest) longest = forward - last, limit = -last;
        last = forward;
    }
    return limit;
}

/// The camera of the scene whose view is taken; null: none. Throws InputError where there is none of that name.
const SceneCamera* chosen_camera(const Assembly& assembly, const ViewRequest& request) {
    const bool is_placed = request.position_m || request.look_at_m;
    if (request.camera.empty()) {
        for (const SceneCamera& camera : assembly.cameras)
            if (camera.has_place() && !is_placed) return &camera;
        return nullptr;
    }
    std::string names;
    for (const SceneCamera& camera : assembly.cameras) {
        names += (names.empty() ? "\"" : ", \"") + camera.name + '"';
        if (camera.name != request.camera) continue;
        if (is_placed) throw InputError("a camera of the scene and a position or look-at exclude each other");
        if (camera.has_place()) return &camera;
        throw InputError("the scene's camera \"" + camera.name + "\" is orthographic, which no lens is");
    }
    if (request.camera == ViewRequest::kNoCamera) return nullptr;
    throw InputError("the scene has no camera \"" + request.camera + "\"; " +
                     (names.empty() ? "it has none" : "it has " + names));
}

/// Where a camera of the scene is: the entrance pupil of the lens in its place.
Pose pose_of(const Affine<double>& scene_from_camera, const LensSystem& lens) {
    const Vec3d backward = normalized(scene_from_camera.z);
    const double pupil = nominal_first_order(lens).entrance_pupil_position;
    const double film_to_pupil_m = (lens.film_position() - (std::isfinite(pupil) ? pupil : 0.0)) / 1000;
    const Vec3d position = scene_from_camera.origin + film_to_pupil_m * backward;
    return {position, position - backward, normalized(scene_from_camera.y)};
}

/// Takes the place, the direction and the motion of a camera of the scene.
void take_view(Camera& camera, const Assembly& assembly, const SceneCamera& from,
               const std::optional<double>& focus_distance_m) {
    const LensSystem lens = camera.lens;
    const Affine<double> place = from.transform_at(camera.shutter.opens_s);
    if (focus_distance_m) {
        camera.lens = focused(lens, 1000 * *focus_distance_m);
        camera.pose = pose_of(place, camera.lens);
        validate(camera);
    } else {
        const BoundingBox box = Surroundings(assembly).box();
        // Where the film is depends on the focus, and that on where the film is.
        for (int i = 0; i < 4; ++i) {
            camera.pose = pose_of(place, camera.lens);
            validate(camera);
            const AxisCrossings axis(assembly, camera.pose.position_m, -normalized(place.z));
            camera.lens = focused(lens, 1000 * autofocus_m(axis, 0, box, camera));
        }
        camera.pose = pose_of(place, camera.lens);
    }
    if (!from.motion) return;
    std::vector<PoseKey> keys;
    for (std::size_t k = 0; k < from.motion->times_s.size(); ++k)
        keys.push_back({from.motion->times_s[k], pose_of(from.motion->transforms[k], camera.lens)});
    set_motion(camera, std::move(keys));
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
    const Surroundings subject(assembly);
    const BoundingBox& box = subject.box();
    const LensSystem lens = camera.lens;
    camera.pose.up = request.up;
    camera.pose.look_at_m = request.look_at_m.value_or(box.middle());
    const auto focus = [&](const AxisCrossings& axis, double film_m) {
        camera.lens = focused(lens, 1000 * autofocus_m(axis, film_m, box, camera));
    };
    if (request.position_m) {
        camera.pose.position_m = *request.position_m;
        validate(camera);
        if (request.focus_distance_m) {
            camera.lens = focused(lens, 1000 * *request.focus_distance_m);
            return nullptr;
        }
        const Vec3d forward = normalized(camera.pose.look_at_m - camera.pose.position_m);
        focus(AxisCrossings(assembly, camera.pose.position_m, forward), 0);
        return nullptr;
    }
    const bool z_is_up = std::fabs(request.up.z) > 0.99 * length(request.up);
    const Vec3d backward = z_is_up ? Vec3d{0, -1, 0} : Vec3d{0, 0, 1};
    camera.pose.position_m = camera.pose.look_at_m + backward;
    validate(camera);
    const AxisCrossings axis(assembly, camera.pose.look_at_m, -backward);
    const bool room = !request.look_at_m && is_room(assembly, subject, backward);
    double limit = 0.99 * free_distance(axis, box, room, camera.pose.look_at_m, backward);
    if (request.focus_distance_m) camera.lens = focused(lens, 1000 * *request.focus_distance_m);
    // The field narrows as the lens focuses nearer, and the lens focuses nearer as the field widens.
    double least = 0;
    for (int i = 0, settled = 0; i < 100 && settled < 4; ++i) {
        const double distance = std::max(least, std::min(limit, filling_distance(box, camera, camera.pose.look_at_m)));
        stand_back(camera, backward, distance);
        if (request.focus_distance_m) {
            ++settled;
            continue;
        }
        try {
            focus(axis, -dot(camera.pose.position_m - camera.pose.look_at_m, backward));
            ++settled;
        } catch (const InputError&) {
            if (i == 99) throw;
            least = 1.2 * distance;
            limit = kInfinity;
            settled = 0;
        }
    }
    return nullptr;
}

}  // namespace realcam
