#pragma once
#include <optional>
#include <vector>

#include "../trace/film_frame.hpp"
#include "tangent_path.hpp"

namespace REALCAM_NAMESPACE {

/// Line of directions at a film point, along which the edge of the pupil is searched: optical direction cosines
/// start + t step towards the scene, in the film's frame.
struct DirectionLine {
    Vec2d film;  ///< film point, mm
    Vec2d start, step;
};

/// Point of the pupil's outline at a film point: a ray that grazes a rim, and passes all others.
struct OutlinePoint {
    double t = 0;  ///< position on the line; 0: no point was found
    int surface = 0;  ///< index of the surface on the path towards the scene
    /// Tangent of the ray's optical direction, in the surface's frame, for TangentPath::trace: its x and y are the unit
    /// normal of the rim, towards the rays that it blocks.
    Vec3d tangent{};
    double stop_rate = 0;  ///< motion of the rim along the normal per growth of the diaphragm's radius; 0 except on it
    double inverse_speed = 0;  ///< inverse of the speed, per t, with which the ray moves across the rim, 1/mm
    Vec3d origin{}, direction{};  ///< ray in front of the lens, in the camera's frame: mm, optical direction
};

/// Finds points of the outline of a lens's pupil by real rays. The points lie on the true rims but for roundings.
class OutlineRays {
public:
    static constexpr int kLanes = TangentPath::kLanes;
    /// Largest number of outline points on one line that are found: a pupil with a central obstruction has two.
    static constexpr int kMostPoints = 2;

    /// Throws InputError if the lens has an aperture of another shape than a circle, a ring or blades.
    OutlineRays(const LensSystem& lens, double wavelength_nm);

    /// Searches the lines from t = 0 to `end`. Returns the number of edges that no rim explains, such as those of total
    /// internal reflection. `path`: tangents of the same lens. `wavelengths`: see TangentPath::trace.
    int find(const TangentPath& path, const DirectionLine (&lines)[kLanes], double end,
             const WavelengthsInDouble* wavelengths, OutlinePoint (&points)[kMostPoints][kLanes]) const;

    /// Starts rays with tangents along the lines at t.
    TangentPath::Rays start(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes]) const;

private:
    /// Distance of a point to the nearest edge of a surface's opening: positive inside.
    struct Edge {
        double distance;
        Vec2d normal;
        double stop_rate;
    };
    Edge edge_at(const SurfaceView<double>& surface, Vec2d at) const;
    /// Edge that is nearest to a lane's ray, and the speed per t with which the ray approaches it.
    struct NearestRim {
        Edge edge;
        int surface;
        double speed;
    };
    NearestRim nearest_rim(const std::vector<TangentPath::Crossing>& crossings, int lane) const;
    /// Finds the edges between `low` and `high` by the secant method, and sets t. Returns false if an edge is not known
    /// to 1e-8 of its interval: where no rim explains it, or an interval has several edges.
    bool refine(const DirectionLine (&lines)[kLanes], const WavelengthsInDouble* wavelengths,
                const double (&low)[kLanes], const double (&high)[kLanes], const int (&low_passes)[kLanes],
                double (&t)[kLanes]) const;
    /// Sets `clearance` to the distance of each lane's ray at t from the nearest edge, mm: positive for rays that pass,
    /// and minus infinity for rays that miss a surface or are totally reflected.
    void measure(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes],
                 const WavelengthsInDouble* wavelengths, double (&clearance)[kLanes]) const;
    /// Sets `passes` to 1 for each lane whose ray at t passes the lens.
    void trace(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes], const WavelengthsInDouble* wavelengths,
               int (&passes)[kLanes]) const;

    LensPath<double> lens_;
    LensView<double> view_;
    double film_distance_, squared_index_;
    bool stop_is_rim_ = false;  ///< the diaphragm is round
    int stop_index_;
    double apothem_rate_ = 0, curvature_rate_ = 0;  ///< rates of the blades, per growth of the diaphragm's radius
};

}  // namespace REALCAM_NAMESPACE
