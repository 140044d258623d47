#include "ghost_tables.hpp"

#include <algorithm>

#include "../math/append_cdf.hpp"
#include "../optics/ghost/film_mirror.hpp"
#include "../optics/ghost/ghost_coatings.hpp"
#include "../optics/lens/axial_share.hpp"
#include "lens_way.hpp"

namespace realcam {

namespace ghost_tables_detail {

std::vector<Crossing> all_crossings(const LensSystem& lens) {
    std::vector<Crossing> all;
    for (int i = 0; i < static_cast<int>(lens.surfaces.size()); ++i)
        for (const bool in_order : {false, true})
            for (const bool is_reflected : {false, true}) {
                const bool can_be = lens.surfaces[static_cast<std::size_t>(i)].type == SurfaceType::refracting;
                all.push_back({i, in_order, is_reflected && can_be});
            }
    return all;
}

}  // namespace ghost_tables_detail

GhostTables::GhostTables(const LensSystem& of_lens, double film_radius, const GhostChoice& choice,
                         const PupilTracer& tracer, const FilmSpectrum* spectrum)
    : effects_{.dispersion = spectrum != nullptr, .coatings = true},
      film_radius_(static_cast<float>(film_radius)),
      film_index_(static_cast<float>(of_lens.indices(of_lens.wavelength_nm).back())),
      entry_reach_(entry_reach(of_lens)),
      exit_reach_(static_cast<float>(exit_reach(of_lens))) {
    using namespace ghost_tables_detail;
    check_traces_lights(LensPath<float>(of_lens, LightDirection::to_film, of_lens.wavelength_nm).view());
    const LensSystem lens = with_film_mirror(of_lens, choice.film_reflectance, film_radius);
    std::vector<GhostPair> pairs;
    std::vector<double> axial;
    // For a spectrum the mean is taken: light that a coating stops at the design wavelength it reflects at another.
    std::vector<AxialShares> of_wavelengths;
    for (const double wavelength : spectrum ? spectrum->even_wavelengths() : std::vector{lens.wavelength_nm})
        of_wavelengths.emplace_back(lens, wavelength);
    const auto axial_share = [&](const std::vector<Crossing>& way) {
        double sum = 0;
        for (const AxialShares& share : of_wavelengths) sum += share(way);
        return sum / static_cast<double>(of_wavelengths.size());
    };
    const auto look_at = [&](const std::vector<GhostPair>& wanted) {
        for (const GhostPair pair : wanted) {
            // A way that no more light can take than ten times what the lens itself takes is not worth the search.
            const double share = axial_share(crossings_of(of_lens, pair));
            if (!(10 * share > choice.least_share)) continue;
            pairs.push_back(pair);
            axial.push_back(share);
        }
    };
    if (choice.of_lens) look_at(ghost_pairs(of_lens));
    if (choice.film_reflectance > 0) look_at(film_ghost_pairs(of_lens));
    const EntrySearch search(of_lens, film_radius, tracer);
    std::vector<std::vector<FoundRay>> found(pairs.size() + 1);  // the last of the lens itself
    tracer.for_each(static_cast<int>(found.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const auto way = k < pairs.size() ? crossings_of(of_lens, pairs[k]) : crossings_of(of_lens);
        found[k] = search.along(lens, way);
    });
    for (const std::vector<FoundRay>& rays : found)
        largest_half_tangent_ = std::max(largest_half_tangent_, largest_half_tangent_of(rays));
    make_crossings(lens, spectrum);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double share = axial[k] * etendue_of(found[k]) / etendue_of(found.back());
        if (!(share > choice.least_share)) continue;
        pairs_.push_back(pairs[k]);
        shares_.push_back(share);
        const std::vector<Crossing> way = crossings_of(of_lens, pairs[k]);
        const auto path = [&](LightDirection direction) {
            return LensPath<float>(lens, way, direction, lens.wavelength_nm);
        };
        add(to_film_, path(LightDirection::to_film), way, entries_of(found[k], largest_half_tangent_));
        add(to_scene_, path(LightDirection::to_scene), reversed(way), exits_of(found[k]));
    }
    set_probabilities();
    const LensPath<float> straight(of_lens, LightDirection::to_film, lens.wavelength_nm);
    iris_ = straight.view().iris;
    kind_ = straight.view().kind;
}

GhostView GhostTables::view_of_objects() const {
    double share = 0;
    for (const double of_pair : shares_) share += of_pair;
    const auto samples = static_cast<std::int32_t>(std::clamp(0.5 / share, 16.0, 256.0));
    return view_of(to_scene_, GhostLight::of_objects, samples, exit_reach_);
}

GhostView GhostTables::view_of(const Ways& of, GhostLight light, std::int32_t pixel_samples, float reach) const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    return {light,
            effects_,
            pixel_samples,
            of.ways.data(),
            static_cast<int>(of.ways.size()),
            cdf_.data(),
            of.entries.data(),
            static_cast<int>(of.surfaces.size()),
            of.surfaces.data(),
            data_of(of.coatings),
            data_of(of.indices),
            data_of(of.spectral_coatings),
            largest_half_tangent_,
            film_radius_,
            film_index_,
            reach,
            iris_,
            kind_};
}

void GhostTables::make_crossings(const LensSystem& lens, const FilmSpectrum* spectrum) {
    all_ = ghost_tables_detail::all_crossings(lens);
    if (!spectrum) {
        const double design = lens.wavelength_nm;
        all_coatings_ =
            ghost_coatings(lens, all_, fit_coatings<kOneWavelengthTerms>(lens, all_, {design}), {design, design});
        return;
    }
    const WavelengthRange range = spectrum->range();
    all_indices_ = index_cubics(lens, all_, range);
    all_spectral_ = ghost_coatings(
        lens, all_, fit_coatings<kGhostSpectrumTerms>(lens, all_, spectrum->even_wavelengths(), variable_over(range)),
        range);
}

void GhostTables::add(Ways& to, const LensPath<float>& path, const std::vector<Crossing>& crossings,
                      const GhostEntries& entries) {
    const LensView<float> way = path.view();
    to.ways.push_back({static_cast<std::int32_t>(to.surfaces.size()), way.count, 0});
    to.surfaces.insert(to.surfaces.end(), way.surfaces, way.surfaces + way.count);
    to.entries.insert(to.entries.end(), entries.begin(), entries.end());
    for (const Crossing& crossing : crossings) {
        const std::size_t number = ghost_tables_detail::number_of(crossing);
        if (!all_coatings_.empty()) to.coatings.push_back(all_coatings_[number]);
        if (all_indices_.empty()) continue;
        to.indices.push_back(all_indices_[number]);
        to.spectral_coatings.push_back(all_spectral_[number]);
    }
}

void GhostTables::set_probabilities() {
    if (shares_.empty()) return;
    double sum = 0;
    for (const double share : shares_) sum += share;
    std::vector<double> weights;
    for (const double share : shares_) weights.push_back(0.9 * share / sum + 0.1 / static_cast<double>(shares_.size()));
    append_cdf(weights, cdf_);
    for (Ways* of : {&to_film_, &to_scene_})
        for (std::size_t k = 0; k < weights.size(); ++k) of->ways[k].probability = cdf_[k + 1] - cdf_[k];
}

}  // namespace realcam
