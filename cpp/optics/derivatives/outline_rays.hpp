#pragma once
#include "../trace/film_frame.hpp"
#include "outline_search.hpp"
#include "tangent_path.hpp"

namespace REALCAM_NAMESPACE {

/// Finds points of the outline of a lens's pupil by real rays. The points lie on the true rims but for roundings.
class OutlineRays {
public:
    static constexpr int kLanes = TangentPath::kLanes;
    static constexpr int kMostPoints = kMostOutlinePoints;

    /// Throws InputError if the lens has an aperture of another shape than a circle, a ring or blades.
    OutlineRays(const LensSystem& lens, double wavelength_nm);

    /// View for the search with other blocks of rays, valid as long as this object.
    const OutlineLens& view() const { return view_; }

    /// Searches the lines from t = 0 to `end` (find_outline). `path`: tangents of the same lens. `wavelengths`: see
    /// TangentPath::trace.
    int find(const TangentPath& path, const DirectionLine (&lines)[kLanes], double end,
             const WavelengthsInDouble* wavelengths, OutlinePoint (&points)[kMostPoints][kLanes]) const;

    /// Starts rays with tangents along the lines at t.
    TangentPath::Rays start(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes]) const {
        return view_.start(lines, t);
    }

private:
    /// Sets `clearance` by measure_clearance.
    void measure(const TangentLens& surfaces, const DirectionLine (&lines)[kLanes], const double (&t)[kLanes],
                 const WavelengthsInDouble* wavelengths, double (&clearance)[kLanes]) const;
    /// Sets `passes` to 1 for each lane whose ray at t passes the lens.
    void trace(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes], const WavelengthsInDouble* wavelengths,
               int (&passes)[kLanes]) const;

    LensPath<double> lens_;
    OutlineLens view_;
};

}  // namespace REALCAM_NAMESPACE
