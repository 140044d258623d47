#pragma once
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/pupil/pupil_view.hpp"
#include "entry_search.hpp"

namespace REALCAM_NAMESPACE {

/// Where light from far away enters a lens to reach the film, as rays of the pupil show it: by its angle to the axis.
class PupilEntries {
public:
    /// `lens`: from the film to the scene. `film_radius`: of a circle that holds the film, and `film_distance` behind
    /// the last vertex, mm.
    PupilEntries(const PupilView& pupil, const LensView<float>& lens, double film_radius, double film_distance,
                 const PupilTracer& tracer);

    /// An upper bound of the tangents of half the angles of light that is seen.
    float largest_half_tangent() const { return largest_half_tangent_; }
    /// Of the largest one, where the tangent is larger.
    const GhostEntry& at(float half_tangent) const;

private:
    float largest_half_tangent_;
    GhostEntries entries_;
};

}  // namespace REALCAM_NAMESPACE
