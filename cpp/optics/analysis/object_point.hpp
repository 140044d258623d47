#pragma once
#include <optional>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A field point, specified by an angle or by the film point of its chief ray at the design wavelength. If specified by
/// an angle, it lies in the y-z plane. For a positive angle, the light comes from below the axis and rises towards +y
/// on its way to the film.
struct FieldPoint {
    double angle_rad = 0;  ///< angle of the chief ray to the axis; up to 180 degrees for an object at infinity
    /// Distance from the object plane to the front vertex, mm; may be infinite; empty: the plane in focus. At a finite
    /// distance, the field angle is that of the object point as seen from the centre of the paraxial entrance pupil.
    std::optional<double> object_distance = std::nullopt;
    std::optional<Vec2<double>> film = std::nullopt;  ///< mm from the film's centre; if set, `angle_rad` is ignored

    /// Returns a description for messages, such as "at a field angle of 10 deg".
    std::string text() const;
};

namespace object_point_detail {

/// Formats an angle in degrees, such as "10 deg".
std::string degrees(double radians);

}  // namespace object_point_detail

/// Returns the distance from the object plane of a field point to the front vertex, mm. Throws InputError if the
/// distance or the field angle is invalid.
double object_distance_of(const LensSystem& lens, const FieldPoint& field);

/// An object point at a finite or infinite distance, described by its rays in front of the lens. Rays are parametrised
/// by their intersection with a plane near the lens, the entry plane. Path lengths are relative to that of the ray
/// through the centre of the entry plane, and contain only the inverse of the object's distance, so that infinity needs
/// no special case.
class ObjectPoint {
public:
    /// Entry point: intersection of a ray with the entry plane, the plane through `centre` perpendicular to `towards`.
    /// Coordinates along `across` and `upwards`, relative to `centre`, mm.
    using Entry = Vec2<double>;

    /// Centre of the entry plane, mm: the centre of the paraxial entrance pupil, in the lens frame. If the field is
    /// specified by its film point or the lens is not rotationally symmetric: the intersection of the chief ray with
    /// the front surface, in the frame of film_path_ends.
    Vec3d centre;
    Vec3d towards;  ///< unit vector: direction of the ray through the centre
    Vec3d across, upwards;  ///< unit vectors: axes of the entry plane; for a point on the axis x and y
    double inverse_distance;  ///< 1 / distance of the object from the centre, 1/mm; 0: infinity

    /// Throws InputError if the field point is invalid, or if the lens has no chief ray or entrance pupil for it.
    ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    /// Returns the position of an entry point, mm.
    Vec3d at(Entry entry) const { return centre + offset(entry); }
    /// Returns the direction of the ray through an entry point, a unit vector.
    Vec3d direction(Entry entry) const { return normalized(towards + inverse_distance * offset(entry)); }

    /// Returns the distance from the object to an entry point minus that to the centre, mm: sqrt(D^2 + q^2) - D for the
    /// object distance D and the offset q from the centre, without cancellation.
    double path_difference(Entry entry) const;

private:
    Vec3d offset(Entry entry) const { return entry.x * across + entry.y * upwards; }

    /// Sets all members but `across` and `upwards`, from the field angle or from the chief ray. Throw InputError as the
    /// constructor does.
    void set_by_angle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);
    void set_by_chief_ray(const LensSystem& lens, const FieldPoint& field);
};

}  // namespace REALCAM_NAMESPACE
