#include "object_point.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../lens/chief_ray.hpp"
#include "../lens/paraxial.hpp"

namespace realcam {

namespace object_point_detail {

std::string degrees(double radians) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g deg", radians * 180 / std::numbers::pi);
    return text;
}

}  // namespace object_point_detail

std::string FieldPoint::text() const {
    if (!film) return "at a field angle of " + object_point_detail::degrees(angle_rad);
    char text[80];
    std::snprintf(text, sizeof text, "at the film point (%.6g, %.6g) mm", film->x, film->y);
    return text;
}

namespace {

/// Distance from the plane in focus to the front vertex, mm.
double distance_in_focus(const LensSystem& lens) {
    return lens.focus_distance - lens.film_position();
}

}  // namespace

double object_distance_of(const LensSystem& lens, const FieldPoint& field) {
    const double distance = field.object_distance.value_or(distance_in_focus(lens));
    const double degrees = field.angle_rad * 180 / std::numbers::pi;
    const bool finite = std::isfinite(distance);
    if (!(distance > 0)) throw InputError("the object distance must be a positive length, or inf");
    if (!(std::fabs(degrees) < (finite ? 90 : 180)))
        throw InputError("the field angle is " + object_point_detail::degrees(field.angle_rad) +
                         (!finite ? "; expected less than 180 deg"
                          : field.object_distance
                              ? "; expected less than 90 deg for an object at a finite distance"
                              : "; expected less than 90 deg for the plane in focus, at a finite distance"));
    return distance;
}

ObjectPoint::ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    if (field.film || !lens.is_rotational())
        set_by_chief_ray(lens, field);
    else
        set_by_angle(lens, wavelength_nm, field);
    across = {1, 0, 0};
    if (towards.x != 0) across = normalized(cross(Vec3d{0, 1, 0}, towards));
    upwards = cross(towards, across);
}

void ObjectPoint::set_by_angle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    const double object_distance = object_distance_of(lens, field);
    const double pupil = first_order(lens, wavelength_nm).entrance_pupil_position;
    if (!std::isfinite(pupil))
        throw InputError("lens \"" + lens.name +
                         "\" is telecentric on the object's side: its entrance pupil lies at infinity, so that no "
                         "field angle determines an object point");
    const double cosine = std::cos(field.angle_rad);
    centre = {0, 0, pupil};
    towards = {0, std::sin(field.angle_rad), cosine};
    inverse_distance = cosine / (object_distance + pupil);
    if (!std::isfinite(inverse_distance))
        throw InputError("the object lies in the entrance pupil of lens \"" + lens.name + "\"");
}

void ObjectPoint::set_by_chief_ray(const LensSystem& lens, const FieldPoint& field) {
    // z of the object plane in the camera frame. The focus distance is measured from the film, not from the front
    // surface.
    const double plane =
        field.object_distance ? -object_distance_of(lens, field) : camera_film_position(lens) - lens.focus_distance;
    const RaysFromFilm rays(lens, lens.wavelength_nm);
    const std::optional<ChiefRay> chief =
        field.film ? chief_ray_of_film_point(rays, *field.film) : chief_ray_of_angle(rays, field.angle_rad);
    if (!chief)
        throw InputError("no ray " + field.text() + " reaches the centre of the stop of lens \"" + lens.name + "\"");
    centre = chief->scene;
    towards = chief->scene_direction;
    inverse_distance = towards.z / (centre.z - plane);
    if (!(inverse_distance >= 0))
        throw InputError("the light " + field.text() + " does not come from the object plane of lens \"" + lens.name +
                         "\"");
}

double ObjectPoint::path_difference(Entry entry) const {
    const double square = entry.x * entry.x + entry.y * entry.y;
    return square * inverse_distance / (1 + std::sqrt(1 + square * inverse_distance * inverse_distance));
}

}  // namespace realcam
