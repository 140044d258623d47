#include "camera_setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "../math/hypotenuse.hpp"
#include "../math/motion.hpp"
#include "../optics/lens/exposure.hpp"
#include "effects/direct_lens_path.hpp"
#include "film/pixel_filter.hpp"
#include "models/exposed_rays.hpp"
#include "models/pinhole_camera.hpp"

namespace realcam {

using namespace camera_detail;

namespace {

/// Poses of the camera at uniformly spaced times of the exposure; empty if it does not move meanwhile. Throws
/// InputError if it rotates too fast.
std::vector<Affine<double>> exposure_keys(const Camera& camera) {
    if (!camera.moves()) return {};
    const Motion motion = motion_of(camera.motion);
    const TimeInterval exposure = camera.exposure();
    // Near objects show the camera's translation, and far ones its rotation, so each must be resolved by itself.
    Motion rotations = motion, translations = motion;
    for (Affine<double>& rotation : rotations.transforms) rotation.origin = {0, 0, 0};
    for (Affine<double>& translation : translations.transforms)
        translation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, translation.origin};
    const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, middle[] = {{0, 0, 0}};
    const std::optional<int> rotation_steps = key_steps(rotations, exposure, axes),
                             translation_steps = key_steps(translations, exposure, middle);
    if (!rotation_steps || !translation_steps)
        throw InputError("the camera turns too fast; at most about 20 turns in one exposure are supported");
    const int steps = std::max(*rotation_steps, *translation_steps);
    return steps == 0 ? std::vector<Affine<double>>() : uniform_keys(motion, exposure, steps);
}

/// Circle of confusion of the ideal lens in the entrance pupil. Let R be the radius of its pupil, and b and s_f the
/// distances from it to the film and to the plane in focus. The rays of a point at s fill the pupil. They cover a disc
/// of diameter 2 R |s_f - s| / s in the plane in focus, and one b / s_f times as large on the film. If the entrance
/// pupil is at infinity, the matrix of the real lens is used.
CircleOfConfusion circle_of_confusion(double entrance_pupil_position, ThinLens thin, ThickLens thick,
                                      double film_distance) {
    const double radius = static_cast<double>(thin.pupil_radius), image = static_cast<double>(thin.image_distance),
                 inverse = static_cast<double>(thin.inverse_object_distance);
    CircleOfConfusion circle{};
    if (std::isfinite(entrance_pupil_position) && std::isfinite(radius * image * inverse)) {
        // s = t + entrance_pupil_position, and the ray through the pupil's centre rises by s / b.
        circle.rim = static_cast<float>(radius * (1 - inverse * entrance_pupil_position));
        circle.rim_slope = static_cast<float>(-radius * inverse);
        circle.middle = static_cast<float>(entrance_pupil_position / image);
        circle.middle_slope = static_cast<float>(1 / image);
        circle.least_middle = static_cast<float>(radius / image);
        return circle;
    }
    const double A = static_cast<double>(thick.A), B = static_cast<double>(thick.B), C = static_cast<double>(thick.C),
                 D = static_cast<double>(thick.D), pupil = static_cast<double>(thick.exit_pupil_distance);
    // Height and slope at the front vertex of a ray with a height and slope at the film.
    const auto front = [&](double film, double slope) {
        const double last = film - film_distance * slope;
        return std::pair(static_cast<float>(D * last - B * slope), static_cast<float>(C * last - A * slope));
    };
    std::tie(circle.rim, circle.rim_slope) = front(0, static_cast<double>(thick.exit_pupil_radius) / pupil);
    std::tie(circle.middle, circle.middle_slope) = front(1, 1 / pupil);
    circle.least_middle = std::numeric_limits<float>::min();
    return circle;
}

/// Tracer of the pupil search for a camera with ray pairs. Rays that the search sends only to the stop arrive at the
/// point of the disc in which they lie farthest outside, so that light passes where they arrive inside the stop.
PupilTracer ray_pair_tracer(const Camera& camera, PupilTracer tracer) {
    const auto table = camera.ray_pairs;
    const auto distance = static_cast<float>(table->film_distance),
               stop_radius = static_cast<float>(camera.lens.open_stop_radius());
    const int surfaces = static_cast<int>(camera.lens.surfaces.size());
    tracer.trace = [=](const LensView<float>& lens, PupilTracer::Rays& rays) {
        const LensPolynomialView view = table->view();
        if (lens.count == surfaces) return trace_polynomial(view, distance, rays);
        for (int i = 0; i < PupilTracer::kBlock; ++i) {
            const Vec3f film = rays.origin[i], direction = rays.direction[i];
            const float along = distance / direction.z;
            const LensPolynomialArguments<float> at(view, {film.x, film.y},
                                                    {film.x - along * direction.x, film.y - along * direction.y});
            Vec2f farthest = {0, 0};
            for (int disc = 0; disc < view.disc_count; ++disc) {
                const Vec2f point = disc_point(view, disc, at);
                if (hypotenuse(point.x, point.y) > hypotenuse(farthest.x, farthest.y)) farthest = point;
            }
            rays.origin.set(i, {stop_radius * farthest.x, stop_radius * farthest.y, 0});
        }
    };
    return tracer;
}

}  // namespace

CameraSetup::CameraSetup(const Camera& camera, PupilTracer tracer, const CameraSetup* last, const LensEffects& effects,
                         PupilStart start)
    : camera_(validated(camera)),
      effects_(effects),
      path_(camera.lens, LightDirection::to_scene, camera.lens.wavelength_nm,
            film_path_ends(camera.lens, LightDirection::to_scene)),
      tables_(camera.lens, film_radius(), effects, tracer, last ? &last->tables_ : nullptr) {
    if (camera.ray_pairs) tracer = ray_pair_tracer(camera, std::move(tracer));
    const std::vector<Affine<double>> keys = exposure_keys(camera);
    for (const Affine<double>& key : keys) keys_.push_back(placement(key, keys.front().origin));
    if (!has_real_pupil(camera.model)) {
        validate_ideal(camera.lens, camera.model);
        axis_irradiance_ = last && !has_real_pupil(last->camera_.model) && last->camera_.lens == camera.lens
                               ? last->axis_irradiance_
                               : static_cast<float>(axis_irradiance(camera.lens));
        if (camera.model == CameraModel::mapped_lens) set_map(tracer, last);
        set_bundle_motions(tracer, last);
        return;
    }
    if (camera.model == CameraModel::polynomial_lens) require_radial_pupil(camera.lens, "the camera model polynomial");
    set_pupil(tracer, last, start);
    check_light();
    if (camera.model == CameraModel::polynomial_lens && !camera.ray_pairs)
        polynomial_.emplace(camera.lens, pupil_->view(), std::min(film_radius(), pupil_->image_radius()));
    if (traces_lights() && uses_rotational_code(camera.lens))
        pupil_entries_ = last && last->pupil_entries_ && last->pupil_ == pupil_
                             ? last->pupil_entries_
                             : std::make_shared<const PupilEntryBounds>(pupil_->view(), path_.view(), film_radius(),
                                                                        camera.lens.film_distance, tracer);
    if (camera.model == CameraModel::full_lens_double) {
        path_in_double_.emplace(camera.lens, LightDirection::to_scene, camera.lens.wavelength_nm,
                                film_path_ends(camera.lens, LightDirection::to_scene));
        view_in_double_ = path_in_double_->view();
    }
    set_bundle_motions(tracer, last);
}

CameraView CameraSetup::view(Vec3d origin_m, bool scene_moves) const {
    const LensSystem& lens = camera_.lens;
    // The first-order data of a decentred lens only serve to estimate blur: its elements are centred on one axis.
    const LensSystem on_axis = centred(lens);
    const FirstOrder data = first_order(on_axis, lens.wavelength_nm);
    CameraView view{};
    static_cast<CameraFrame&>(view) =
        placement(scene_from_camera(pose_at(camera_, camera_.exposure().begin_s)), origin_m);
    view.model = camera_.model;
    view.width = camera_.film.width;
    view.height = camera_.film.height;
    view.filter = effects_.pixel_filter;
    view.film_half_width = static_cast<float>(0.5 * camera_.film.width_mm);
    view.film_half_height = static_cast<float>(0.5 * camera_.film.height_mm);
    view.film_centre = {static_cast<float>(-camera_.film.shift_mm.x), static_cast<float>(-camera_.film.shift_mm.y)};
    view.film_distance = static_cast<float>(lens.film_distance);
    view.film_curvature = static_cast<float>(1 / lens.film_radius_of_curvature);
    view.front_vertex_m = static_cast<float>(0.001 * camera_film_position(lens));
    view.pupil_m = static_cast<float>(0.001 * (lens.film_position() - data.entrance_pupil_position));
    view.thin = thin_lens_of(on_axis, data);
    view.thick = thick_lens_of(on_axis, data);
    if (map_) view.map = map_->view();
    if (bundle_motions_) view.bundles = bundle_motions_->view();
    view.circle = circle_of_confusion(data.entrance_pupil_position, view.thin, view.thick, lens.film_distance);
    view.axis_irradiance = axis_irradiance_;
    if (pupil_) view.pupil = pupil_->view();
    if (pupil_grid_) view.pupil_grid = pupil_grid_->view();
    view.lens = path_.view();
    if (path_in_double_) view.lens_in_double = &view_in_double_;
    if (polynomial_) view.polynomial = polynomial_->view();
    if (camera_.ray_pairs) view.polynomial = camera_.ray_pairs->view();
    const double across = std::fabs(static_cast<double>(view.thin.image_distance));
    static_cast<EffectViews&>(view) = tables_.views(camera_.film.width_mm * camera_.film.height_mm / (across * across));
    set_times(view, scene_moves);
    return view;
}

const Camera& CameraSetup::validated(const Camera& camera) {
    validate(camera);
    return camera;
}

void CameraSetup::set_pupil(const PupilTracer& tracer, const CameraSetup* last, PupilStart start) {
    const std::vector<double>& wavelengths = tables_.pupil_wavelengths();
    const bool is_comparable = last && last->has_pupil_for(wavelengths, effects_.pupil_sampling);
    const bool is_unchanged = is_comparable && last->has_lens_and_film_of(*this);
    if (is_unchanged && last->has_new_pupil()) {
        pupil_ = last->pupil_;
        pupil_grid_ = last->pupil_grid_;
        return;
    }
    const Pupil* similar =
        is_comparable && !is_unchanged && start == PupilStart::near_last ? last->pupil_.get() : nullptr;
    const LensSystem lens = sampled_lens(camera_.lens, effects_.pupil_sampling);
    if (has_radial_pupil(lens))
        pupil_ = std::make_shared<const Pupil>(lens, film_radius(), tracer, wavelengths, similar);
    else
        pupil_grid_ = std::make_shared<const PupilGrid>(lens, film_area(), mirror_planes(lens), tracer, wavelengths);
}

void CameraSetup::check_light() const {
    const std::string lens = "lens \"" + camera_.lens.name + "\"";
    if (!(camera_.lens.stop_semi_diameter > 0)) throw InputError("no light passes " + lens + ": its stop is closed");
    if (pupil_ ? !(pupil_->image_radius() > 0) : !pupil_grid_->is_lit())
        throw InputError(
            "no light passes " + lens +
            " in this state: its central obstruction is larger than its open stop, or rays miss one of its surfaces");
    if (pupil_ && !pupil_->is_continuous())
        throw InputError("the stop of " + lens + ", a hole of radius " +
                         std::to_string(1000 * camera_.lens.stop_semi_diameter) +
                         " um, is too small for pictures through every surface; open it, or use another camera model");
}

Film CameraSetup::sampled_film() const {
    Film film = camera_.film;
    const double margins = 2 * static_cast<double>(filter_radius(effects_.pixel_filter)) - 1;
    film.width_mm *= 1 + margins / film.width;
    film.height_mm *= 1 + margins / film.height;
    return film;
}

FilmArea CameraSetup::film_area() const {
    const Film film = sampled_film();
    // The image on the film is inverted: the film's axes are opposite to the picture's.
    const Vec2<double> middle = {-film.shift_mm.x, -film.shift_mm.y};
    return {{middle.x - 0.5 * film.width_mm, middle.y - 0.5 * film.height_mm},
            {middle.x + 0.5 * film.width_mm, middle.y + 0.5 * film.height_mm}};
}

double CameraSetup::widest_angle() const {
    const LensSystem& lens = camera_.lens;
    if (camera_.geometry) return std::min(field_of_view(camera_).diagonal / 2, camera_.geometry->inverse.max_angle);
    if (camera_.ray_pairs) return camera_.ray_pairs->field_angle(film_radius());
    if (lens.is_rotational() && (has_real_pupil(camera_.model) || map_)) {
        const double angle = widest_field_angle(lens, film_radius());
        if (std::isfinite(angle)) return angle;
    }
    const LensSystem on_axis = centred(lens);
    const ThinLens thin = thin_lens_of(on_axis, first_order(on_axis, lens.wavelength_nm));
    return std::atan(film_radius() / std::fabs(static_cast<double>(thin.image_distance)));
}

void CameraSetup::set_map(const PupilTracer& tracer, const CameraSetup* last) {
    const LensSystem& lens = camera_.lens;
    if (last && last->map_ && last->has_lens_and_film_of(*this)) {
        map_ = last->map_;
        return;
    }
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const double image = static_cast<double>(thin_lens_of(lens, data).image_distance);
    map_ = std::make_shared<const LensMap>(lens, film_radius(), image, data.entrance_pupil_position, tracer);
}

void CameraSetup::set_bundle_motions(const PupilTracer& tracer, const CameraSetup* last) {
    if (!camera_.geometry) return;
    const bool is_unchanged = last && last->bundle_motions_ && last->camera_.geometry == camera_.geometry &&
                              last->camera_.model == camera_.model && last->has_lens_and_film_of(*this);
    bundle_motions_ = is_unchanged
                          ? last->bundle_motions_
                          : std::make_shared<const BundleMotions>(camera_, view(camera_.pose.position_m), tracer);
}

CameraFrame CameraSetup::placement(const Affine<double>& scene_from_camera, Vec3d origin_m) {
    return {static_cast<Vec3f>(scene_from_camera.origin - origin_m), static_cast<Vec3f>(scene_from_camera.x),
            static_cast<Vec3f>(scene_from_camera.y), static_cast<Vec3f>(scene_from_camera.z)};
}

void CameraSetup::set_times(CameraView& view, bool scene_moves) const {
    view.keys = keys_.data();
    view.key_count = static_cast<int>(keys_.size());
    if (keys_.empty() && !scene_moves) return;
    const double all = camera_.shutter.readout_time_s + camera_.seen_time();
    view.row_time = static_cast<float>(camera_.shutter.readout_time_s / all / camera_.film.height);
    view.exposed_time = static_cast<float>(camera_.seen_time() / all);
}

bool CameraSetup::has_lens_and_film_of(const CameraSetup& other) const {
    const Film film = sampled_film(), others = other.sampled_film();
    return camera_.lens == other.camera_.lens && camera_.ray_pairs == other.camera_.ray_pairs &&
           film.width_mm == others.width_mm && film.height_mm == others.height_mm && film.shift_mm == others.shift_mm;
}

bool CameraSetup::has_pupil_for(const std::vector<double>& wavelengths, PupilSampling sampling) const {
    return (pupil_ || pupil_grid_) && tables_.pupil_wavelengths() == wavelengths && effects_.pupil_sampling == sampling;
}

std::shared_ptr<const CameraSetup> LastSetup::make(const Camera& camera, const PupilTracer& tracer,
                                                   const LensEffects& effects, PupilStart start) {
    const std::pair key(camera.model, camera.geometry != nullptr);
    std::shared_ptr<const CameraSetup> last;
    {
        // The lock is not held during the search of the pupil, so that no thread waits for another thread's camera.
        const std::lock_guard lock(mutex_);
        const auto found = setups_.find(key);
        last = found != setups_.end() ? found->second : latest_;
    }
    auto setup = std::make_shared<const CameraSetup>(camera, tracer, last.get(), effects, start);
    const std::lock_guard lock(mutex_);
    return setups_[key] = latest_ = std::move(setup);
}

}  // namespace realcam
