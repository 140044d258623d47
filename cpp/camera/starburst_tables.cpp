#include "starburst_tables.hpp"

#include <utility>

namespace realcam {

StarburstTables::StarburstTables(const LensSystem& lens, double film_radius, std::shared_ptr<const DirectLensPath> way,
                                 const PupilTracer& tracer)
    : way_(std::move(way)) {
    const std::vector<FoundRay> found = EntrancePupilSearch(lens, film_radius, tracer).along(lens, crossings_of(lens));
    largest_half_tangent_ = largest_half_tangent_of(found);
    entries_ = entries_of(found, largest_half_tangent_);
}

GhostView StarburstTables::view() const {
    GhostView view = way_->view(GhostLight::starbursts, kSamplesPerSplat);
    view.entries = entries_.data();
    view.largest_half_tangent = largest_half_tangent_;
    return view;
}

}  // namespace realcam
