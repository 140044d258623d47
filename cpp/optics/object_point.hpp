#pragma once
#include <cstdio>
#include <numbers>
#include <optional>

#include "../math/vec3.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// A place in the field, as users name it. It lies in the y-z plane; an angle above 0 is light that rises towards +y on
/// its way to the film, from below the axis.
struct FieldPoint {
    double angle_rad = 0;  ///< at which the chief ray comes, to the axis; up to 180 degrees for an object at infinity
    /// mm from the object plane to the front vertex, infinity allowed; none: the plane in focus. The point of a finite
    /// plane is seen at the angle from the middle of the paraxial entrance pupil.
    std::optional<double> object_distance = std::nullopt;
};

namespace object_point_detail {

inline std::string degrees(double radians) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g deg", radians * 180 / std::numbers::pi);
    return text;
}

}  // namespace object_point_detail

/// mm from the plane in focus to the front vertex.
inline double distance_in_focus(const LensSystem& lens) {
    return lens.focus_distance - lens.film_position();
}

/// mm from the object plane of a field point to the front vertex. Throws InputError for what is no place in the field.
inline double object_distance_of(const LensSystem& lens, const FieldPoint& field) {
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

/// One point of the object, as its rays are near the lens. A point at infinity is no special case: lengths from the
/// object are differences to that of the ray through the entry plane's centre, in a form in which the object's distance
/// does not appear but as its inverse.
class ObjectPoint {
public:
    /// Where a ray crosses the entry plane, the plane through `centre` across `towards`: mm along x, and along the
    /// direction across x and `towards` that is y for a point on the axis.
    using Entry = Vec2<double>;

    Vec3d centre;  ///< the middle of the paraxial entrance pupil, lens frame
    Vec3d towards;  ///< unit: of the ray through the centre
    double inverse_distance;  ///< 1 / distance of the object from the centre, 1/mm; 0: infinity

    ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field) {
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

    Vec3d at(Entry entry) const { return centre + offset(entry); }
    Vec3d direction(Entry entry) const { return normalized(towards + inverse_distance * offset(entry)); }

    /// Length from the object to the point of the entry plane, less that to its centre, mm: with D the distance and q
    /// the offset, sqrt(D^2 + q^2) - D without its cancellation.
    double path_difference(Entry entry) const {
        const double square = entry.x * entry.x + entry.y * entry.y;
        return square * inverse_distance / (1 + std::sqrt(1 + square * inverse_distance * inverse_distance));
    }

private:
    Vec3d offset(Entry entry) const { return {entry.x, entry.y * towards.z, -entry.y * towards.y}; }
};

}  // namespace REALCAM_NAMESPACE
