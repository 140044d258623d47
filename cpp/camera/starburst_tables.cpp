#include "starburst_tables.hpp"

#include <utility>

namespace realcam {

StarburstTables::StarburstTables(const LensSystem& lens, double film_radius,
                                 std::shared_ptr<const DirectLensPath> direct_path, const PupilTracer& tracer)
    : direct_path_(std::move(direct_path)) {
    const EntrancePupilSearch<FilmRings> search(lens, film_radius, tracer);
    const std::vector<FoundRay> found = search.along(lens, crossings_of(lens));
    directions_ = FilmRings::directions_of({found});
    entries_ = entries_of<FilmRings>(found, directions_);
}

GhostView StarburstTables::view() const {
    GhostView view = direct_path_->view(GhostLight::starbursts, kSamplesPerSplat);
    view.entries = entries_.data();
    view.largest_half_tangent = directions_.largest;
    return view;
}

}  // namespace realcam
