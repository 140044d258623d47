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
    RaysFromFilm(const LensSystem& lens, double wavelength_nm);

    double film_index() const { return path_.entry_index; }
    double scene_index() const { return scene_index_; }
    double film_distance() const { return film_distance_; }
    /// Radius of the stop's opening, which is treated as round, mm.
    double stop_radius() const { return stop_radius_; }
    Vec3d film_point(Vec2<double> film) const;
    /// Point of the last surface; `share`: x and y in units of its clear semi-diameter.
    Vec3d on_last_surface(Vec2<double> share) const;

    /// Traces rays to the plane of the stop, in its frame.
    template <int N>
    void to_stop(LensRays<double, N>& rays) const {
        trace_lens(open_.first(to_stop_), rays);
    }
    /// Traces rays to the stop like to_stop, but with the rims in front of it blocking rays.
    template <int N>
    void to_stop_within_rims(LensRays<double, N>& rays) const {
        trace_lens(within_rims_.first(to_stop_), rays);
    }
    template <int N>
    void to_scene(LensRays<double, N>& rays) const {
        trace_lens(open_.view(), rays);
    }

private:
    PathEnds ends_;
    LensPath<double> path_;
    AimingPath open_, within_rims_;
    Affine<double> frame_of_last_;
    Surface last_;
    double film_distance_, film_curvature_, scene_index_, stop_radius_;
    int to_stop_;
};

/// Chief ray of a film point: through the stop's centre, even if a rim blocks it. Directions are unit vectors in the
/// direction of the light, towards the film.
struct ChiefRay {
    Vec3d film, film_direction;  ///< intersection with the film; film frame, mm
    Vec3d scene, scene_direction;  ///< intersection with the front surface; camera frame, mm
};

/// Finds the chief ray of a film point by Newton's method. It starts with the ray nearest to the stop's centre out of a
/// grid of rays to the last surface. Returns std::nullopt if no ray is found.
std::optional<ChiefRay> chief_ray_of_film_point(const RaysFromFilm& rays, Vec2<double> film);

/// Finds the chief ray by Newton's method alone, starting with these optical direction cosines (x and y, towards the
/// scene). Returns std::nullopt if it does not converge.
std::optional<ChiefRay> chief_ray_near(const RaysFromFilm& rays, Vec2<double> film, Vec2<double> cosines);

/// Finds the chief ray at an angle to the camera's axis, in its y-z plane; above 0 light rises towards +y. It is
/// followed from the film's centre in steps of at most 5 degrees. Returns std::nullopt if a step fails.
std::optional<ChiefRay> chief_ray_of_angle(const RaysFromFilm& rays, double angle_rad);

}  // namespace REALCAM_NAMESPACE
