#include "starburst_tables.hpp"

#include "../optics/ghost/ghost_coatings.hpp"

namespace realcam {

StarburstTables::StarburstTables(const LensSystem& lens, double film_radius, const FilmSpectrum& spectrum,
                                 const Effects& effects, const PupilTracer& tracer)
    : effects_(effects),
      path_(lens, LightDirection::to_film, lens.wavelength_nm),
      way_{0, path_.view().count, 1},
      reach_(entry_reach(lens)) {
    const std::vector<FoundRay> found = EntrySearch(lens, film_radius, tracer).along(lens, crossings_of(lens));
    largest_half_tangent_ = largest_half_tangent_of(found);
    entries_ = entries_of(found, largest_half_tangent_);
    const double design = lens.wavelength_nm;
    const std::vector<Crossing> way = crossings_of(lens);
    const WavelengthRange range = effects.dispersion ? spectrum.range() : WavelengthRange{design, design};
    indices_ = index_cubics(lens, way, range);
    if (effects.coatings)
        coatings_ = ghost_coatings(
            lens, way,
            fit_coatings<kGhostSpectrumTerms>(lens, way, spectrum.even_wavelengths(), variable_over(spectrum.range())),
            range);
}

GhostView StarburstTables::view() const {
    const LensView<float> lens = path_.view();
    return {GhostLight::starbursts,
            effects_,
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

}  // namespace realcam
