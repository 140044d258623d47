#include "effect_tables.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "../../optics/trace/film_frame.hpp"
#include "../../optics/trace/lens_dispersion.hpp"

namespace realcam {

EffectTables::EffectTables(const LensSystem& lens, double film_radius, const LensEffects& effects,
                           const PupilTracer& tracer, const EffectTables* last)
    : effects_(effects), lens_(lens), film_radius_(film_radius) {
    const bool has_same_lens = last && last->effects_ == effects && last->lens_ == lens;
    const EffectTables* const unchanged = has_same_lens && last->film_radius_ == film_radius ? last : nullptr;
    if (effects.illuminant)
        set_wavelengths(FilmSpectrum(*effects.illuminant, effects.filter));
    else if (effects.even_wavelengths)
        set_wavelengths(FilmSpectrum(*effects.even_wavelengths));
    if (effects.coatings) set_coatings(has_same_lens ? last : nullptr);
    direct_lens_path_ = has_same_lens ? last->direct_lens_path_ : std::make_shared<LazyDirectLensPath>();
    if (effects.ghosts)
        ghosts_ = unchanged ? unchanged->ghosts_
                            : std::make_shared<const GhostTables>(lens, film_radius, *effects.ghosts, tracer,
                                                                  effects.dispersion ? &*spectrum_ : nullptr);
    if (!effects.diffraction) return;
    diffraction_ =
        unchanged ? unchanged->diffraction_ : std::make_shared<const DiffractionTables>(lens, film_radius, tracer);
    starbursts_ = unchanged
                      ? unchanged->starbursts_
                      : std::make_shared<const StarburstTables>(lens, film_radius, shared_direct_lens_path(), tracer);
}

EffectViews EffectTables::views(double film_angle) const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    EffectViews views{};
    views.effects = effects_;
    const LensView<float> film_path = film_path_ ? film_path_->view() : LensView<float>{};
    if (spectrum_) {
        views.dispersion = {spectrum_->cells().data(),
                            static_cast<int>(spectrum_->cells().size()),
                            variable_over(spectrum_->range()),
                            data_of(to_scene_),
                            data_of(to_film_),
                            film_path.surfaces,
                            film_path.free};
        const std::array<float, 9> mean = spectrum_->mean_film();
        std::copy(mean.begin(), mean.end(), views.dispersion.film);
        if (effects_.filter) {
            const auto white_of = [&](std::size_t c) { return mean[3 * c] + mean[3 * c + 1] + mean[3 * c + 2]; };
            constexpr float kDark = 1e-3f;  // channels with less of the brightest one's light have no control variate
            const float darkest = kDark * std::max({white_of(0), white_of(1), white_of(2)});
            for (std::size_t c = 0; c < 3; ++c)
                views.dispersion.white_scale[c] = white_of(c) > darkest ? 1 / white_of(c) : 0;
        }
    }
    views.coatings = {data_of(coatings_), data_of(coatings_to_scene_), data_of(coatings_to_film_)};
    if (diffraction_) views.diffraction = diffraction_->view(film_angle);
    return views;
}

std::vector<GhostView> EffectTables::splats() const {
    std::vector<GhostView> views;
    if (ghosts_ && !ghosts_->pairs().empty()) views = {ghosts_->view(), ghosts_->view_of_objects()};
    if (starbursts_) views.push_back(starbursts_->view());
    return views;
}

void EffectTables::set_wavelengths(FilmSpectrum spectrum) {
    spectrum_ = std::move(spectrum);
    if (!effects_.dispersion && !effects_.coatings) return;
    // The code for diffraction with coatings uses index tables over a spectrum; without dispersion they hold one
    // wavelength.
    const double design = lens_.wavelength_nm;
    const WavelengthRange range = effects_.dispersion ? spectrum_->range() : WavelengthRange{design, design};
    check_dispersion(lens_, range);
    const std::vector<double> wavelengths = effects_.dispersion ? spectrum_->even_wavelengths() : std::vector{design};
    const WavelengthVariable variable = variable_over(spectrum_->range());
    to_scene_ = index_cubics(lens_, LightDirection::to_scene, wavelengths, variable);
    to_film_ = index_cubics(lens_, LightDirection::to_film, wavelengths, variable);
    film_path_.emplace(lens_, LightDirection::to_film, design, film_path_ends(lens_, LightDirection::to_film));
    pupil_wavelengths_ = {std::clamp(design, range.first, range.last)};
    for (const double end : {range.first, range.last})
        if (end != pupil_wavelengths_.front()) pupil_wavelengths_.push_back(end);
}

void EffectTables::set_coatings(const EffectTables* same) {
    if (same) {
        coatings_ = same->coatings_;
        coatings_to_scene_ = same->coatings_to_scene_;
        coatings_to_film_ = same->coatings_to_film_;
        return;
    }
    if (!spectrum_) {
        check_wavelength_in_glasses(lens_, lens_.wavelength_nm, "coatings");
        coatings_ = fit_coatings<kOneWavelengthTerms>(lens_, LightDirection::to_scene, {lens_.wavelength_nm});
        return;
    }
    const std::vector<double> wavelengths = spectrum_->even_wavelengths();
    for (const double end : {wavelengths.front(), wavelengths.back()})
        check_wavelength_in_glasses(lens_, end, "coatings");
    const WavelengthVariable variable = variable_over(spectrum_->range());
    coatings_to_scene_ = fit_coatings<kSpectrumTerms>(lens_, LightDirection::to_scene, wavelengths, variable);
    coatings_to_film_ = fit_coatings<kSpectrumTerms>(lens_, LightDirection::to_film, wavelengths, variable);
}

std::shared_ptr<const DirectLensPath> EffectTables::shared_direct_lens_path() const {
    std::call_once(direct_lens_path_->once, [&] {
        direct_lens_path_->path = std::make_shared<const DirectLensPath>(lens_, spectrum_, effects_);
    });
    return direct_lens_path_->path;
}

}  // namespace realcam
