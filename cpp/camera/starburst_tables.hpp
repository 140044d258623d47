#pragma once
#include <array>
#include <vector>

#include "diffraction_view.hpp"
#include "entry_search.hpp"
#include "film_spectrum.hpp"

namespace REALCAM_NAMESPACE {

/// The way of light through the lens that no surface reflects, on which lamps make starbursts. Owns the memory of its
/// view.
class StarburstTables {
public:
    /// `film_radius`: of a circle that holds the film, mm. Throws InputError where an index is not known.
    StarburstTables(const LensSystem& lens, double film_radius, const FilmSpectrum& spectrum, const Effects& effects,
                    const PupilTracer& tracer);

    GhostView view() const;

private:
    static constexpr std::array<float, 2> kCdf = {0, 1};

    Effects effects_;
    LensPath<float> path_;
    GhostWay way_;
    GhostEntries entries_{};
    std::vector<IndexCubic> indices_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> coatings_;
    float largest_half_tangent_ = 0, reach_;
};

}  // namespace REALCAM_NAMESPACE
