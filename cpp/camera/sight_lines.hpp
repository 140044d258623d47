#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "../math/odd_curve.hpp"
#include "../optics/analysis/scene_bundle.hpp"
#include "../optics/trace/ray_loop.hpp"
#include "lines_of_sight.hpp"

namespace REALCAM_NAMESPACE {

/// The line along which a film point looks into the scene, in the plane of the axis, mm.
struct SightLine {
    double angle;   ///< to the axis, rad; above 0: away from it on the side that shows on this side of the picture
    double offset;  ///< of the line from the reference point, across it
    double start;  ///< where it leaves the lens, along it from the foot of the perpendicular from the reference point
    double light;  ///< irradiance for an even field, over that in the middle of the film
};

/// The line of sight of each radius of the film, in front of the camera's lens or of the model that stands for it.
/// Lenses are round, and blades are replaced by the circle of their area, so one radius stands for all.
class SightLines : public LinesOfSight {
public:
    /// `setup`: of the camera. The lines go out to the corners of its film. Throws InputError.
    SightLines(const CameraSetup& setup, SightRay ray, const RayLoop& loop = {});

    bool ends_in_film() const override { return ends_in_film_; }
    bool is_in_front(Vec3d point) const override { return -point.z > reference_; }
    std::optional<FilmSight> from(Vec2<double> place) const override;
    std::optional<Vec2<double>> place_of(Vec3d point) const override;

private:
    static constexpr int kSteps = 256;
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    /// Distances from the front vertex and from the film, mm.
    struct ThinLensPlace {
        double position, image_distance;
    };

    /// A place in the plane of the axis: away from it, and towards the scene from the reference point, mm.
    struct Place {
        double away, ahead;
    };

    /// `film_radius` from 0 to reach_. Nothing where no light arrives.
    std::optional<SightLine> at(double film_radius) const;

    /// The film radius whose line goes through a place in front of the lens; the one nearest to the axis, if there are
    /// several. Nothing where no line does.
    std::optional<double> radius_towards(Place place) const;

    double radius_of(double place) const { return reach_ * place / kSteps; }

    OddCurve curve_of(double SightLine::* value, bool rises = false) const;

    /// What a film point at +y sees lies at -y.
    void set(int k, const std::optional<SceneRay>& ray, double light);

    /// Finds the mean rays of as many film radii as it takes for cubics between them to be right.
    void follow_light(const LensSystem& lens, const PupilView& pupil, const RayLoop& loop);

    void follow_chief_rays(const LensSystem& lens, const PupilView& pupil);

    /// The line of a camera model that has no surfaces goes through the middle of the pupil.
    void set_ideal(int k, const CameraView& view, ThinLensPlace thin);

    /// At the edge of the image, where rims leave little of the light, its mean may come from farther inwards again:
    /// what lies there has a place already. Turns all lines to the side on which they lead away from the axis.
    void end_where_lines_turn_back();

    /// Share of the step at which its line meets the place: Newton's method, kept between the sides of the root.
    double root(int k, Place place) const;

    /// Of the reference point, the middle of the paraxial entrance pupil, or the front vertex where that is far away:
    /// mm from the film towards the scene, and from the front vertex.
    double reference_, vertex_;
    double focus_;  ///< from it to the plane in focus
    double reach_ = 0;  ///< film radius beyond which nothing is known of lines, mm
    bool ends_in_film_ = false;
    int sign_ = 1;  ///< -1 where the picture is upside down, as behind a lens with an image inside it
    std::vector<SightLine> lines_;
    OddCurve angle_, offset_;
    std::vector<double> cosines_, sines_;
};

}  // namespace REALCAM_NAMESPACE
