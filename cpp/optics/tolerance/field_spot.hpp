#pragma once
#include <cmath>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// The rays of one field of a copy, of all colours, behind the lens.
struct FieldSpot {
    std::vector<FieldFan::FilmRay> rays;  ///< whose weights have the sum 1, or none
    double light;                         ///< share of the rays that pass
    FieldFan::FilmRay chief;              ///< of the main colour
    double film;                          ///< where the film is before it is set, mm behind the last vertex
    double index;                         ///< of refraction, behind the lens

    /// The mean square radius about the middle, as a function of the place of the film: a + 2 b z + c z^2, z from
    /// `film`.
    struct Square {
        double a, b, c;
    };
    Square square() const;
    /// Half the width of the light behind the lens, as the slope of an even disc.
    double half_slope() const { return std::sqrt(2 * square().c); }
    Vec2<double> chief_at(double shift) const;
    /// Contrast of rays alone at this frequency, periods per mm, of lines across this unit vector.
    double contrast(double shift, Vec2<double> along, double frequency) const;
    /// Adds the contrast on `sum.size()` planes, the first `shift` from the film and each `step` behind the one before.
    void add_contrast(double shift, double step, Vec2<double> along, double frequency, std::vector<double>& sum) const;
    /// The contrast of a lens without aberrations by diffraction, with a pupil that is an ellipse as wide as the light.
    double limit(Vec2<double> along, double frequency, const std::vector<StudyColour>& colours) const;
};

}  // namespace REALCAM_NAMESPACE
