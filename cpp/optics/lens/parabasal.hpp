#pragma once
#include <array>

#include "../../math/matrix2.hpp"
#include "chief_ray.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// First-order (parabasal) ray transfer of a lens of any kind about a chief ray, as 2 x 2 matrices. A ray is a position
/// (mm, across the chief ray, along x and nearly y of the frame) and an optical direction across the chief ray.
struct ParabasalRays {
    ChiefRay chief;
    Matrix2 position_by_position, position_by_direction;  ///< film side by scene side
    Matrix2 direction_by_position, direction_by_direction;
    Matrix2 stop_by_position, stop_by_direction;  ///< stop by scene side
    Matrix2 stop_by_film_position, stop_by_film_direction;  ///< stop by film side
};

/// Parabasal rays about a known chief ray. Throws InputError if rays close to it do not leave the lens.
ParabasalRays parabasal_rays(const LensSystem& lens, const RaysFromFilm& rays, const ChiefRay& chief);

/// Parabasal rays about the chief ray of a film point. Throws InputError if no chief ray is found.
ParabasalRays parabasal_rays(const LensSystem& lens, double wavelength_nm, Vec2<double> film = {0, 0});

/// Centre of the entrance pupil on the chief ray, mm in the camera frame: where rays to the stop's centre cross, the
/// mean of both meridians. `index`: refractive index in front of the lens. Not finite if the pupil is at infinity.
Vec3d entrance_pupil_middle(const ParabasalRays& rays, double index);

/// Distance from the exit pupil to a film point along its chief ray, mm. The exit pupil is where rays from the stop's
/// centre cross, the mean of both meridians. Throws InputError if no chief ray of the film point is found.
double exit_pupil_distance(const LensSystem& lens, double wavelength_nm, Vec2<double> film);

/// First-order data in one of the two principal meridians: planes through the chief ray in which light stays, as far as
/// focal lengths are concerned. Lengths in mm; a power of 0 has an infinite focal length.
struct Meridian {
    double azimuth_deg;  ///< azimuth of the plane in front of the lens, from the x axis towards y; -90 to 90
    double focal_length;
    double back_focal_distance;  ///< last vertex to the focus, along the chief ray
    double f_number;
    double entrance_pupil_diameter;
};

/// First-order data of a lens of any kind, about the chief ray of the film's centre.
struct ParabasalData {
    std::array<Meridian, 2> meridians;  ///< the one nearer to the x axis first
    double squeeze;  ///< focal length of the second over that of the first
    /// Data of both meridians combined, as for a lens of revolution: f-number and focal length are geometric means, so
    /// that the f-number is that of the exposure; positions are means of both meridians, along the unfolded axis.
    FirstOrder mean;
};

/// Throws InputError if no light from the film's centre reaches the stop's centre.
ParabasalData parabasal_data(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
