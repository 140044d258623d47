#include "object_point.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "../lens/paraxial.hpp"

namespace realcam {

namespace object_point_detail {

std::string degrees(double radians) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g deg", radians * 180 / std::numbers::pi);
    return text;
}

}  // namespace object_point_detail

namespace {

/// mm from the plane in focus to the front vertex.
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
                         (!finite ? "; less than 180 deg is wanted"
                          : field.object_distance
                              ? "; less than 90 deg is wanted for an object at a finite distance"
                              : "; less than 90 deg is wanted for the plane in focus, at a finite distance"));
    return distance;
}

ObjectPoint::ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
    const double object_distance = object_distance_of(lens, field);
    const double pupil = first_order(lens, wavelength_nm).entrance_pupil_position;
    if (!std::isfinite(pupil))
        throw InputError("lens \"" + lens.name +
                         "\" is telecentric on the object's side: its entrance pupil lies at infinity, so that no "
                         "field angle names a point");
    const double cosine = std::cos(field.angle_rad);
    centre = {0, 0, pupil};
    towards = {0, std::sin(field.angle_rad), cosine};
    inverse_distance = cosine / (object_distance + pupil);
    if (!std::isfinite(inverse_distance))
        throw InputError("the object lies in the entrance pupil of lens \"" + lens.name + "\"");
}

double ObjectPoint::path_difference(Entry entry) const {
    const double square = entry.x * entry.x + entry.y * entry.y;
    return square * inverse_distance / (1 + std::sqrt(1 + square * inverse_distance * inverse_distance));
}

}  // namespace realcam
