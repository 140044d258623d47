#pragma once
#include <array>
#include <vector>

#include "../optics/fit_coatings.hpp"
#include "../optics/lens_dispersion.hpp"
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
        if (light.has_coatings) set_coatings(lens, way, light.spectrum, range);
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

    void set_coatings(const LensSystem& lens, const std::vector<Crossing>& way, const FilmSpectrum& spectrum,
                      WavelengthRange range) {
        const auto fitted =
            fit_coatings<kSpectrumTerms>(lens, way, spectrum.even_wavelengths(), variable_over(spectrum.range()));
        const std::vector<IndexCubic> beyond = index_cubics(lens, way, range, true);
        const std::vector<double> design = lens.indices(lens.wavelength_nm);
        for (std::size_t k = 0; k < way.size(); ++k) {
            const double n = way[k].index_before(design);
            coatings_.push_back({fitted[k], beyond[k], static_cast<float>(n * n), false, {}});
        }
    }

    LensPath<float> path_;
    GhostWay way_;
    GhostEntries entries_{};
    std::vector<IndexCubic> indices_;
    std::vector<GhostCoating<kSpectrumTerms>> coatings_;
    float largest_half_tangent_ = 0, reach_;
};

}  // namespace REALCAM_NAMESPACE
