#pragma once
#include <array>

#include "../../math/matrix2.hpp"
#include "chief_ray.hpp"
#include "paraxial.hpp"

namespace REALCAM_NAMESPACE {

/// What a lens of any kind does to the rays close to a chief ray, by first order: matrices of 2 x 2, for which a ray is
/// a place (mm, across the chief ray, in x and nearly in y of the frame) and an optical direction across it.
struct ParabasalRays {
    ChiefRay chief;
    Matrix2 place_by_place, place_by_direction;  ///< on the film's side, by those on the scene's
    Matrix2 direction_by_place, direction_by_direction;
    Matrix2 stop_by_place, stop_by_direction;  ///< on the stop, by those on the scene's side
    Matrix2 stop_by_film_place, stop_by_film_direction;  ///< and on the film's
};

/// About a chief ray that is known already. Throws InputError where rays beside it do not leave the lens.
ParabasalRays parabasal_rays(const LensSystem& lens, const RaysFromFilm& rays, const ChiefRay& chief);

/// Throws InputError where no chief ray of that film point is found.
ParabasalRays parabasal_rays(const LensSystem& lens, double wavelength_nm, Vec2<double> film = {0, 0});

/// The middle of the entrance pupil on the chief ray, mm in the frame of the camera: where rays to the middle of the
/// stop cross, the mean of both meridians. `index`: of the medium before the lens. Not finite if that is at infinity.
Vec3d entrance_pupil_middle(const ParabasalRays& rays, double index);

/// From the exit pupil on the chief ray of a film point to that point, mm along the ray: where rays from the middle of
/// the stop cross, the mean of both meridians. Throws InputError where no chief ray of the film point is found.
double exit_pupil_distance(const LensSystem& lens, double wavelength_nm, Vec2<double> film);

/// A lens in one of its two principal meridians: planes through the chief ray in which light stays, as far as focal
/// lengths go. Lengths in mm; a power of 0 has an infinite focal length.
struct Meridian {
    double azimuth_deg;  ///< of the plane in front of the lens, from the x axis towards y; -90 to 90
    double focal_length;
    double back_focal_distance;  ///< last vertex to the focus, along the chief ray
    double f_number;
    double entrance_pupil_diameter;
};

/// First-order data of a lens of any kind, about the chief ray of the middle of the film.
struct ParabasalData {
    std::array<Meridian, 2> meridians;  ///< that nearer to the x axis first
    double squeeze;  ///< focal length of the second over that of the first
    /// Of both together, as for a lens of revolution: f-number and focal length are geometric means, so that the
    /// f-number is that of the exposure; places are the means of both meridians, counted along the unfolded axis.
    FirstOrder mean;
};

/// Throws InputError where no light from the middle of the film reaches the middle of the stop.
ParabasalData parabasal_data(const LensSystem& lens, double wavelength_nm);

}  // namespace REALCAM_NAMESPACE
