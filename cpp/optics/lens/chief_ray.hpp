#pragma once
#include <optional>

#include "../trace/aiming_path.hpp"
#include "../trace/film_frame.hpp"

namespace REALCAM_NAMESPACE {

/// Rays from the film of a lens of any kind to the scene, through the lens without its rims.
///
/// They start in the film frame, in which the film's vertex lies at z = `film_distance`, and end in the camera frame
/// (film_path_ends). For a centred lens these are the frames of the last and of the front vertex.
class RaysFromFilm {
public:
    /// Throws InputError if a glass has no index at the wavelength.
    RaysFromFilm(const LensSystem& lens, double wavelength_nm);

    /// Refractive index of the medium at the film.
    double film_index() const { return path_.entry_index; }
    /// Refractive index of the medium in front of the lens.
    double scene_index() const { return scene_index_; }
    /// z of the film's vertex in the film frame, mm.
    double film_distance() const { return film_distance_; }
    /// Radius of the stop's opening, which is treated as round, mm.
    double stop_radius() const { return stop_radius_; }
    /// Returns the point of the film, which may be curved, with these x and y, in the film frame, mm.
    Vec3d film_point(Vec2<double> film) const;
    /// Returns a point of the last surface, in the film frame, mm. `relative`: its x and y in the frame of the surface,
    /// in units of the clear semi-diameter.
    Vec3d on_last_surface(Vec2<double> relative) const;

    /// Traces rays to the plane of the stop; they end in its frame.
    template <int N>
    void to_stop(LensRays<double, N>& rays) const {
        trace_lens(open_.first(to_stop_), rays);
    }
    /// Traces rays to the stop like to_stop, but with the rims in front of it blocking rays.
    template <int N>
    void to_stop_within_rims(LensRays<double, N>& rays) const {
        trace_lens(within_rims_.first(to_stop_), rays);
    }
    /// Traces rays through the whole lens; they end in the camera frame.
    template <int N>
    void to_scene(LensRays<double, N>& rays) const {
        trace_lens(open_.view(), rays);
    }

private:
    PathEnds ends_;
    LensPath<double> path_;
    AimingPath open_, within_rims_;  ///< paths without any rims, and with all rims but that of the stop
    Affine<double> frame_of_last_;  ///< frame of the last surface, in the film frame
    Surface last_;
    double film_distance_, film_curvature_, scene_index_, stop_radius_;
    int to_stop_;  ///< number of surfaces from the film to the stop, including it
};

/// Chief ray of a film point: the ray through the stop's centre, even if a rim blocks it. Directions are unit vectors
/// in the direction of the light, towards the film.
struct ChiefRay {
    Vec3d film, film_direction;  ///< intersection with the film, mm, and direction there; film frame
    Vec3d scene, scene_direction;  ///< intersection with the front surface, mm, and direction in front; camera frame
};

/// Finds the chief ray of a film point by Newton's method. It starts with the ray nearest to the stop's centre out of a
/// grid of rays to the last surface. `film`: x and y of the film point, mm. Returns std::nullopt if no ray is found.
std::optional<ChiefRay> chief_ray_of_film_point(const RaysFromFilm& rays, Vec2<double> film);

/// Finds the chief ray of a film point by Newton's method alone. `cosines`: the start, as x and y of an optical
/// direction (a unit vector times the index) towards the scene. Returns std::nullopt if it does not converge.
std::optional<ChiefRay> chief_ray_near(const RaysFromFilm& rays, Vec2<double> film, Vec2<double> cosines);

/// Chief rays of the film points on the positive y axis of a rotationally symmetric lens, one after the other from the
/// axis outwards, in equal steps.
class MeridionalChiefRays {
public:
    /// `rays` must outlive this object.
    explicit MeridionalChiefRays(const RaysFromFilm& rays) : rays_(rays) {}

    /// Returns the chief ray of the next film point, whose y is `film_y`, mm. It is searched from an extrapolation of
    /// the last two rays or, if that fails, as by chief_ray_of_film_point. Returns std::nullopt if no ray is found.
    std::optional<ChiefRay> next(double film_y);

private:
    const RaysFromFilm& rays_;
    double cosine_ = 0, change_ = 0;  ///< y of the last ray at the film, and its change from the ray before
};

/// Finds the chief ray at a field angle: in the y-z plane of the camera, at `angle_rad` to its z axis; for positive
/// angles, the light travels upwards, towards +y. The ray is found in steps of at most 5 degrees from the film's
/// centre. Returns std::nullopt if a step fails.
std::optional<ChiefRay> chief_ray_of_angle(const RaysFromFilm& rays, double angle_rad);

}  // namespace REALCAM_NAMESPACE
