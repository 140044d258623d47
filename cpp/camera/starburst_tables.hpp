#pragma once
#include <memory>

#include "diffraction_view.hpp"
#include "direct_lens_path.hpp"
#include "entrance_pupil_search.hpp"

namespace REALCAM_NAMESPACE {

/// Entrance-pupil bounds of the light that makes starbursts. Owns the memory of its view.
class StarburstTables {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. `direct_path`: of the same lens.
    StarburstTables(const LensSystem& lens, double film_radius, std::shared_ptr<const DirectLensPath> direct_path,
                    const PupilTracer& tracer);

    GhostView view() const;

private:
    std::shared_ptr<const DirectLensPath> direct_path_;
    HalfTangentBins directions_;
    std::vector<GhostEntry> entries_;
};

}  // namespace REALCAM_NAMESPACE
