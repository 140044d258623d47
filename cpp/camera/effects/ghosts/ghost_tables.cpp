#include "ghost_tables.hpp"

#include <algorithm>

#include "../../../math/sampling_tables.hpp"
#include "../../../optics/ghost/ghost.hpp"
#include "../../../optics/ghost/ghost_coatings.hpp"
#include "../../../optics/lens/exposure.hpp"
#include "../direct_lens_path.hpp"

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

GhostTables::GhostTables(const LensSystem& lens, double film_radius, const GhostChoice& choice,
                         const PupilTracer& tracer, const FilmSpectrum* spectrum)
    : effects_{.dispersion = spectrum != nullptr, .coatings = true},
      film_radius_(static_cast<float>(film_radius)),
      film_index_(static_cast<float>(lens.indices(lens.wavelength_nm).back())) {
    const LensSystem lens_with_film = with_film_mirror(lens, choice.film_reflectance, film_radius);
    std::vector<AxialPair> pairs;
    // With a spectrum, shares are averaged over it: a coating that suppresses light at the design wavelength reflects
    // at another.
    std::vector<AxialTransmittance> transmittances;
    for (const double wavelength : spectrum ? spectrum->even_wavelengths() : std::vector{lens_with_film.wavelength_nm})
        transmittances.emplace_back(lens_with_film, wavelength);
    const auto axial_share = [&](const std::vector<Crossing>& crossings) {
        double sum = 0;
        for (const AxialTransmittance& transmittance : transmittances) sum += transmittance(crossings);
        return sum / static_cast<double>(transmittances.size());
    };
    const auto add_candidates = [&](const std::vector<GhostPair>& candidates) {
        for (const GhostPair pair : candidates) {
            // A ghost is not searched if it stays below the limit even with ten times the etendue of the lens's
            // direct path.
            const double share = axial_share(crossings_of(lens, pair));
            if (10 * share > choice.least_share) pairs.push_back({pair, share});
        }
    };
    if (choice.of_lens) add_candidates(ghost_pairs(lens));
    if (choice.film_reflectance > 0) add_candidates(film_ghost_pairs(lens));
    make_crossings(lens_with_film, spectrum);
    if (uses_rotational_code(lens))
        find_lens_paths(EntrancePupilSearch<FilmRings>(lens, film_radius, tracer), lens, lens_with_film, pairs,
                        choice.least_share, tracer);
    else
        find_lens_paths(EntrancePupilSearch<FilmCells>(lens, film_radius, tracer), lens, lens_with_film, pairs,
                        choice.least_share, tracer);
    set_probabilities();
    const LensPath<float> direct_path(lens, LightDirection::to_film, lens_with_film.wavelength_nm);
    iris_ = direct_path.view().iris;
    kind_ = uses_rotational_code(lens) ? direct_path.view().kind : LensKind::any;
}

template <class Map>
void GhostTables::find_lens_paths(const EntrancePupilSearch<Map>& search, const LensSystem& lens,
                                  const LensSystem& lens_with_film, const std::vector<AxialPair>& pairs,
                                  double least_share, const PupilTracer& tracer) {
    FoundRays found(pairs.size() + 1);  // the last element: direct path of the lens
    tracer.for_each(static_cast<int>(found.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const auto crossings = k < pairs.size() ? crossings_of(lens, pairs[k].pair) : crossings_of(lens);
        found[k] = search.find_rays(lens_with_film, crossings);
    });
    const auto directions = Map::directions_of(found);
    set_maps(directions, search.map());
    entry_reach_ = entry_reach(lens);
    exit_reach_ = static_cast<float>(search.map().rear_reach);
    const auto append = [](std::vector<GhostBounds>& to, const std::vector<GhostBounds>& entries) {
        to.insert(to.end(), entries.begin(), entries.end());
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double share = pairs[k].share * etendue_of(found[k]) / etendue_of(found.back());
        if (!(share > least_share)) continue;
        pairs_.push_back(pairs[k].pair);
        shares_.push_back(share);
        const std::vector<Crossing> crossings = crossings_of(lens, pairs[k].pair);
        const auto path = [&](LightDirection direction) {
            return LensPath<float>(lens_with_film, crossings, direction, lens_with_film.wavelength_nm,
                                   film_path_ends(lens, direction));
        };
        add(to_film_, path(LightDirection::to_film), crossings);
        add(to_scene_, path(LightDirection::to_scene), reversed(crossings));
        append(to_film_.entries, entries_of<Map>(found[k], directions));
        append(to_scene_.entries, exits_of<Map>(found[k]));
    }
}

GhostView GhostTables::view_of_objects() const {
    double share = 0;
    for (const double pair_share : shares_) share += pair_share;
    const auto samples = static_cast<std::int32_t>(std::clamp(0.5 / share, 16.0, 256.0));
    return view_of(to_scene_, GhostLight::of_objects, samples, exit_reach_, film_grid_);
}

GhostView GhostTables::view_of(const LensPaths& lens_paths, GhostLight light, std::int32_t pixel_samples, float reach,
                               const GhostGrid& grid) const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    return {light,
            effects_,
            pixel_samples,
            lens_paths.paths.data(),
            static_cast<int>(lens_paths.paths.size()),
            cdf_.data(),
            data_of(lens_paths.entries),
            static_cast<int>(lens_paths.surfaces.size()),
            lens_paths.surfaces.data(),
            data_of(lens_paths.coatings),
            data_of(lens_paths.indices),
            data_of(lens_paths.spectral_coatings),
            largest_half_tangent_,
            film_radius_,
            film_index_,
            reach,
            iris_,
            kind_,
            grid,
            {data_of(lens_paths.frames), data_of(lens_paths.freeforms), data_of(lens_paths.apertures)}};
}

void GhostTables::make_crossings(const LensSystem& lens, const FilmSpectrum* spectrum) {
    all_ = ghost_tables_detail::all_crossings(lens);
    if (!spectrum) {
        const double design = lens.wavelength_nm;
        all_coatings_ = ghost_coatings(lens, all_, fit_coatings<kOneWavelengthTerms>(lens, all_, {design}), {design});
        return;
    }
    const std::vector<double> wavelengths = spectrum->even_wavelengths();
    const WavelengthVariable variable = variable_over(spectrum->range());
    all_indices_ = index_cubics(lens, all_, wavelengths, variable);
    all_spectral_ = ghost_coatings(lens, all_, fit_coatings<kGhostSpectrumTerms>(lens, all_, wavelengths, variable),
                                   wavelengths, variable);
}

void GhostTables::add(LensPaths& to, const LensPath<float>& path, const std::vector<Crossing>& crossings) {
    const LensView<float> view = path.view();
    const std::size_t first = to.surfaces.size();
    to.paths.push_back({static_cast<std::int32_t>(first), view.count, 0});
    to.surfaces.insert(to.surfaces.end(), view.surfaces, view.surfaces + view.count);
    // Data that one path does not need may be needed by another: missing arrays are padded.
    const auto append = [&](auto& list, const auto* from) {
        if (list.empty() && !from) return;
        list.resize(to.surfaces.size());
        if (from) std::copy(from, from + view.count, list.begin() + static_cast<std::ptrdiff_t>(first));
    };
    append(to.frames, view.free.frames);
    append(to.freeforms, view.free.freeforms);
    append(to.apertures, view.free.apertures);
    for (const Crossing& crossing : crossings) {
        const std::size_t index = ghost_tables_detail::crossing_index(crossing);
        if (!all_coatings_.empty()) to.coatings.push_back(all_coatings_[index]);
        if (all_indices_.empty()) continue;
        to.indices.push_back(all_indices_[index]);
        to.spectral_coatings.push_back(all_spectral_[index]);
    }
}

void GhostTables::set_probabilities() {
    if (shares_.empty()) return;
    double sum = 0;
    for (const double share : shares_) sum += share;
    std::vector<double> weights;
    for (const double share : shares_) weights.push_back(0.9 * share / sum + 0.1 / static_cast<double>(shares_.size()));
    append_cdf(weights, cdf_);
    for (LensPaths* lens_paths : {&to_film_, &to_scene_})
        for (std::size_t k = 0; k < weights.size(); ++k) lens_paths->paths[k].probability = cdf_[k + 1] - cdf_[k];
}

}  // namespace realcam
