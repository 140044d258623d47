#pragma once
#include <optional>

#include "../trace/aiming_path.hpp"
#include "../trace/film_frame.hpp"

namespace REALCAM_NAMESPACE {

/// Rays from the film of a lens of any kind to the scene, through the lens without its rims.
///
/// They begin in the frame of the film, whose vertex stands at `film_distance` on its z axis, and end in that of the
/// camera (film_path_ends). The two are the frames of the last and of the front vertex where the lens is centred.
class RaysFromFilm {
public:
    RaysFromFilm(const LensSystem& lens, double wavelength_nm);

    double film_index() const { return path_.entry_index; }
    double scene_index() const { return scene_index_; }
    double film_distance() const { return film_distance_; }
    /// The opening of the stop counts as round.
    double stop_radius() const { return stop_radius_; }
    Vec3d film_point(Vec2<double> film) const;
    /// A point of the last surface: shares of its clear semi-diameter.
    Vec3d on_last_surface(Vec2<double> share) const;

    /// To the plane of the stop, and into its frame.
    template <int N>
    void to_stop(LensRays<double, N>& rays) const {
        trace_lens(open_.first(to_stop_), rays);
    }
    /// The same for rays that the rims on the way let pass.
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

/// The ray of a film point through the middle of the stop, whether or not a rim blocks it. Directions are unit vectors
/// in the sense of the light, towards the film.
struct ChiefRay {
    Vec3d film, film_direction;    ///< where it meets the film; frame of the film, mm
    Vec3d scene, scene_direction;  ///< where it meets the front surface; frame of the camera, mm
};

/// Nothing where no ray is found: Newton's method, begun with the ray that comes nearest to the stop's middle of a grid
/// of those to the last surface.
std::optional<ChiefRay> chief_ray_of_film_point(const RaysFromFilm& rays, Vec2<double> film);

/// The same by Newton's method alone, begun with the ray of these optical direction cosines (x and y, towards the
/// scene).
std::optional<ChiefRay> chief_ray_near(const RaysFromFilm& rays, Vec2<double> film, Vec2<double> cosines);

/// The chief ray that comes at an angle to the camera's axis, in its y-z plane: above 0 light rises towards +y. It is
/// followed from the middle of the film in steps of at most 5 degrees.
std::optional<ChiefRay> chief_ray_of_angle(const RaysFromFilm& rays, double angle_rad);

}  // namespace REALCAM_NAMESPACE
