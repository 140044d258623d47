#pragma once
#include <optional>

#include "../../math/vec3.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// A place in the field, as users name it: by an angle, or by the film point at which its chief ray of the design
/// wavelength ends. By an angle it lies in the y-z plane; an angle above 0 is light that rises towards +y on its way to
/// the film, from below the axis.
struct FieldPoint {
    double angle_rad = 0;  ///< at which the chief ray comes, to the axis; up to 180 degrees for an object at infinity
    /// mm from the object plane to the front vertex, infinity allowed; none: the plane in focus. The point of a finite
    /// plane is seen at the angle from the middle of the paraxial entrance pupil.
    std::optional<double> object_distance = std::nullopt;
    std::optional<Vec2<double>> film = std::nullopt;  ///< mm from its middle; the angle is not read then

    /// "at a field angle of 10 deg", for messages.
    std::string text() const;
};

namespace object_point_detail {

std::string degrees(double radians);

}  // namespace object_point_detail

/// mm from the object plane of a field point to the front vertex. Throws InputError for what is no place in the field.
double object_distance_of(const LensSystem& lens, const FieldPoint& field);

/// One point of the object, as its rays are near the lens. A point at infinity is no special case. Lengths from the
/// object are relative to that of the ray through the entry plane's centre, in a form that contains only the inverse of
/// the object's distance.
class ObjectPoint {
public:
    /// Where a ray crosses the entry plane, the plane through `centre` across `towards`: mm along `across` and
    /// `upwards`.
    using Entry = Vec2<double>;

    /// The middle of the paraxial entrance pupil, lens frame. Of a field that is named by its film point, and of a lens
    /// that is not of revolution: where the chief ray meets the front surface, in the frame of film_path_ends.
    Vec3d centre;
    Vec3d towards;  ///< unit: of the ray through the centre
    Vec3d across, upwards;  ///< unit: the axes of the entry plane; for a point on the axis x and y
    double inverse_distance;  ///< 1 / distance of the object from the centre, 1/mm; 0: infinity

    ObjectPoint(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);

    Vec3d at(Entry entry) const { return centre + offset(entry); }
    Vec3d direction(Entry entry) const { return normalized(towards + inverse_distance * offset(entry)); }

    /// Length from the object to the point of the entry plane, less that to its centre, mm: with D the distance and q
    /// the offset, sqrt(D^2 + q^2) - D without its cancellation.
    double path_difference(Entry entry) const;

private:
    Vec3d offset(Entry entry) const { return entry.x * across + entry.y * upwards; }

    void set_by_angle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field);
    void set_by_chief_ray(const LensSystem& lens, const FieldPoint& field);
};

}  // namespace REALCAM_NAMESPACE
