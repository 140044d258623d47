#pragma once
#include <array>
#include <vector>

#include "../optics/ghost_coatings.hpp"
#include "diffraction_view.hpp"
#include "entry_search.hpp"
#include "film_spectrum.hpp"

namespace REALCAM_NAMESPACE {

/// The way of light through the lens that no surface reflects, on which lamps make starbursts. Owns the memory of its
/// view.
class StarburstTables {
public:
    struct Light {
        const FilmSpectrum& spectrum;
        bool disperses, has_coatings;
    };

    /// `film_radius`: of a circle that holds the film, mm. Throws InputError where an index is not known.
    StarburstTables(const LensSystem& lens, double film_radius, const Light& light, const PupilTracer& tracer)
        : path_(lens, LightDirection::to_film, lens.wavelength_nm),
          way_{0, path_.view().count, 1},
          reach_(entry_reach(lens)) {
        const std::vector<FoundRay> found = EntrySearch(lens, film_radius, tracer).along(lens, crossings_of(lens));
        largest_half_tangent_ = largest_half_tangent_of(found);
        entries_ = entries_of(found, largest_half_tangent_);
        const double design = lens.wavelength_nm;
        const std::vector<Crossing> way = crossings_of(lens);
        const WavelengthRange range = light.disperses ? light.spectrum.range() : WavelengthRange{design, design};
        indices_ = index_cubics(lens, way, range);
        if (light.has_coatings)
            coatings_ = ghost_coatings(lens, way,
                                       fit_coatings<kGhostSpectrumTerms>(lens, way, light.spectrum.even_wavelengths(),
                                                                         variable_over(light.spectrum.range())),
                                       range);
    }

    GhostView view() const {
        const LensView<float> lens = path_.view();
        return {GhostLight::starbursts,
                kSamplesPerSplat,
                &way_,
                1,
                kCdf.data(),
                entries_.data(),
                lens.count,
                lens.surfaces,
                nullptr,
                indices_.data(),
                coatings_.empty() ? nullptr : coatings_.data(),
                largest_half_tangent_,
                0,
                1,
                reach_,
                lens.iris,
                lens.kind};
    }

private:
    static constexpr std::array<float, 2> kCdf = {0, 1};

    LensPath<float> path_;
    GhostWay way_;
    GhostEntries entries_{};
    std::vector<IndexCubic> indices_;
    std::vector<GhostCoating<kGhostSpectrumTerms>> coatings_;
    float largest_half_tangent_ = 0, reach_;
};

}  // namespace REALCAM_NAMESPACE
