#pragma once
#include "../optics/pupil/pupil_tracer.hpp"
#include "../optics/pupil/pupil_view.hpp"
#include "entrance_pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// Entrance-pupil bounds of light from far away that reaches the film, by its angle to the axis; found with rays
/// through the pupil.
class PupilEntries {
public:
    /// `lens`: for light from the film to the scene. `film_radius`: radius of a circle that contains the film;
    /// `film_distance`: from the last vertex to the film, mm.
    PupilEntries(const PupilView& pupil, const LensView<float>& lens, double film_radius, double film_distance,
                 const PupilTracer& tracer);

    /// Upper bound of the tangents of half the angles to the axis of light that reaches the film.
    float largest_half_tangent() const { return directions_.largest; }
    /// Bounds for the tangent of half the angle to the axis; beyond the largest tangent, those of the last bin.
    const GhostEntry& at(float half_tangent) const {
        return entries_[static_cast<std::size_t>(directions_.bin_of(half_tangent))];
    }

private:
    HalfTangentBins directions_;
    std::vector<GhostEntry> entries_;
};

}  // namespace REALCAM_NAMESPACE
