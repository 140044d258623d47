#pragma once
#include <array>

#include "../../math/matrix2.hpp"
#include "chief_ray.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// First-order (parabasal) ray transfer of a lens of any kind about a chief ray, as 2 x 2 matrices: derivatives of the
/// position or direction of a ray on one side of the lens by those on the other side. A ray near the chief ray has a
/// position, which is its offset in the plane perpendicular to the chief ray, mm, and an optical direction (unit vector
/// times index), given by its two components across the chief ray. The axes across the chief ray are x of the frame
/// and, nearly, y.
struct ParabasalRays {
    ChiefRay chief;
    /// Position and direction at the film by those at the front surface: the A, B, C and D of the ABCD matrix.
    Matrix2 position_by_position, position_by_direction;
    Matrix2 direction_by_position, direction_by_direction;
    /// Point in the stop, mm, by position and direction at the front surface.
    Matrix2 stop_by_position, stop_by_direction;
    /// Point in the stop, mm, by position and direction at the film.
    Matrix2 stop_by_film_position, stop_by_film_direction;
};

/// Returns the parabasal rays about a known chief ray. `rays`: those of the same lens. Throws InputError if rays close
/// to the chief ray do not leave the lens.
ParabasalRays parabasal_rays(const LensSystem& lens, const RaysFromFilm& rays, const ChiefRay& chief);

/// Returns the parabasal rays about the chief ray of the film point with these x and y, mm. Throws InputError if no
/// chief ray is found.
ParabasalRays parabasal_rays(const LensSystem& lens, double wavelength_nm, Vec2<double> film = {0, 0});

/// Returns the centre of the entrance pupil in the camera frame, mm: the point of the chief ray at which rays to the
/// stop's centre cross, as the mean of both meridians. `index`: refractive index in front of the lens. Not finite if
/// the pupil is at infinity.
Vec3d entrance_pupil_centre(const ParabasalRays& rays, double index);

/// Returns the distance from the exit pupil to a film point along its chief ray, mm. The exit pupil is the point at
/// which rays from the stop's centre cross, as the mean of both meridians. Throws InputError if no chief ray of the
/// film point is found.
double exit_pupil_distance(const LensSystem& lens, double wavelength_nm, Vec2<double> film);

/// First-order data in one of the two principal meridians: planes containing the chief ray such that a parallel ray
/// launched in one of them stays in a plane. (They are the singular directions of direction_by_position.) Lengths in
/// mm; a power of 0 has an infinite focal length.
struct Meridian {
    double azimuth_deg;  ///< azimuth of the plane in front of the lens, from the x axis towards y; -90 to 90
    double focal_length;
    double back_focal_distance;  ///< last vertex to the focus of this meridian, along the chief ray
    double f_number;
    double entrance_pupil_diameter;
};

/// First-order data of a lens of any kind, about the chief ray of the film's centre.
struct ParabasalData {
    std::array<Meridian, 2> meridians;  ///< the one nearer to the x axis first
    double squeeze;  ///< anamorphic ratio: focal length of the second meridian over that of the first
    /// Data of both meridians combined, as for a rotationally symmetric lens: f-number and focal length are geometric
    /// means, so that the f-number is that of the exposure; positions are means of both meridians, along the unfolded
    /// axis.
    FirstOrder mean;
};

/// Returns the first-order data about the chief ray of the film's centre. Throws InputError if there is no such ray.
ParabasalData parabasal_data(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
