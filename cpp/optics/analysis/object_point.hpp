#pragma once
#include <optional>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A point of the field, specified by an angle, or by the film point of its chief ray at the design wavelength. By an
/// angle it lies in the y-z plane; an angle above 0 is light that rises towards +y on its way to the film, from below
/// the axis.
struct FieldPoint {
    double angle_rad = 0;  ///< angle of the chief ray to the axis; up to 180 degrees for an object at infinity
    /// Distance from the object plane to the front vertex, mm, infinity allowed; empty: the plane in focus. A point of
    /// a finite plane is at this field angle as seen from the centre of the paraxial entrance pupil.
    std::optional<double> object_distance = std::nullopt;
    std::optional<Vec2<double>> film = std::nullopt;  ///< mm from the film's centre; if set, the angle is ignored

    /// "at a field angle of 10 deg", for messages.
    std::string text() const;
};

namespace object_point_detail {

std::string degrees(double radians);

}  // namespace object_point_detail

/// Distance from the object plane of a field point to the front vertex, mm. Throws InputError if the field point is
/// invalid.
double object_distance_of(const LensSystem& lens, const FieldPoint& field);

/// One object point, described by its rays near the lens. A point at infinity is no special case: path lengths from the
/// object are relative to that of the ray through the entry plane's centre, in a form that contains only the inverse of
/// the object's distance.
class ObjectPoint {
public:
    /// Intersection of a ray with the entry plane, the plane through `centre` perpendicular to `towards`: mm along
    /// `across` and `upwards`.
    using Entry = Vec2<double>;

    /// Centre of the paraxial entrance pupil, lens frame. If the field is specified by its film point, or the lens is
    /// not a lens of revolution: intersection of the chief ray with the front surface, in the frame of film_path_ends.
    Vec3d centre;
    Vec3d towards;  ///< unit vector: ray through the centre
    Vec3d across, upwards;  ///< unit vectors: axes of the entry plane; for a point on the axis x and y
    double inverse_distance;  ///< 1 / distance of the object from the centre, 1/mm; 0: infinity

    ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    Vec3d at(Entry entry) const { return centre + offset(entry); }
    Vec3d direction(Entry entry) const { return normalized(towards + inverse_distance * offset(entry)); }

    /// Length from the object to a point of the entry plane, less that to its centre, mm: sqrt(D^2 + q^2) - D for the
    /// object distance D and the offset q, without cancellation.
    double path_difference(Entry entry) const;

private:
    Vec3d offset(Entry entry) const { return entry.x * across + entry.y * upwards; }

    void set_by_angle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);
    void set_by_chief_ray(const LensSystem& lens, const FieldPoint& field);
};

}  // namespace REALCAM_NAMESPACE
