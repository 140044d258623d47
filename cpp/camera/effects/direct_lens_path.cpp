#include "direct_lens_path.hpp"

#include "../../optics/pupil/film_symmetry.hpp"
#include "../../optics/trace/film_frame.hpp"

namespace realcam {

bool uses_rotational_code(const LensSystem& lens) {
    return has_radial_pupil(lens) &&
           LensPath<float>(lens, LightDirection::to_film, lens.wavelength_nm).view().kind != LensKind::any;
}

DirectLensPath::DirectLensPath(const LensSystem& lens, const std::optional<FilmSpectrum>& spectrum,
                               const Effects& effects)
    : effects_(effects),
      path_(lens, LightDirection::to_film, lens.wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
      kind_(uses_rotational_code(lens) ? path_.view().kind : LensKind::any),
      only_path_{.first = 0, .count = path_.view().count, .probability = 1},
      reach_(entry_reach(lens)) {
    const double design = lens.wavelength_nm;
    const std::vector<Crossing> crossings = crossings_of(lens);
    if (!spectrum) {
        if (effects.coatings)
            coatings_ =
                ghost_coatings(lens, crossings, fit_coatings<kOneWavelengthTerms>(lens, crossings, {design}), {design});
        return;
    }
    const std::vector<double> all = spectrum->even_wavelengths();
    const WavelengthVariable variable = variable_over(spectrum->range());
    // Without dispersion, all wavelengths are refracted as the design wavelength.
    const std::vector<double> refracted = effects.dispersion ? all : std::vector{design};
    indices_ = index_cubics(lens, crossings, refracted, variable);
    if (effects.coatings)
        spectral_coatings_ = ghost_coatings(
            lens, crossings, fit_coatings<kGhostSpectrumTerms>(lens, crossings, all, variable), refracted, variable);
}

GhostView DirectLensPath::view(GhostLight light, std::int32_t pixel_samples) const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    const LensView<float> lens = path_.view();
    GhostView view{};
    view.light = light;
    view.effects = effects_;
    view.pixel_samples = pixel_samples;
    view.paths = &only_path_;
    view.path_count = 1;
    view.cdf = kCdf.data();
    view.crossing_count = lens.count;
    view.surfaces = lens.surfaces;
    view.coatings = data_of(coatings_);
    view.indices = data_of(indices_);
    view.spectral_coatings = data_of(spectral_coatings_);
    view.film_index = 1;
    view.reach = reach_;
    view.iris = lens.iris;
    view.kind = kind_;
    view.free = lens.free;
    return view;
}

}  // namespace realcam
