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

GhostTables::GhostTables(const LensSystem& of_lens, double film_radius, const GhostChoice& choice,
                         const PupilTracer& tracer, const FilmSpectrum* spectrum)
    : effects_{.dispersion = spectrum != nullptr, .coatings = true},
      film_radius_(static_cast<float>(film_radius)),
      film_index_(static_cast<float>(of_lens.indices(of_lens.wavelength_nm).back())) {
    const LensSystem lens = with_film_mirror(of_lens, choice.film_reflectance, film_radius);
    std::vector<AxialPair> pairs;
    // With a spectrum, shares are averaged over it: a coating that suppresses light at the design wavelength reflects
    // at another.
    std::vector<AxialShares> of_wavelengths;
    for (const double wavelength : spectrum ? spectrum->even_wavelengths() : std::vector{lens.wavelength_nm})
        of_wavelengths.emplace_back(lens, wavelength);
    const auto axial_share = [&](const std::vector<Crossing>& crossings) {
        double sum = 0;
        for (const AxialShares& share : of_wavelengths) sum += share(crossings);
        return sum / static_cast<double>(of_wavelengths.size());
    };
    const auto look_at = [&](const std::vector<GhostPair>& wanted) {
        for (const GhostPair pair : wanted) {
            // A ghost is not searched if it stays below the limit even with ten times the etendue of the lens itself.
            const double share = axial_share(crossings_of(of_lens, pair));
            if (10 * share > choice.least_share) pairs.push_back({pair, share});
        }
    };
    if (choice.of_lens) look_at(ghost_pairs(of_lens));
    if (choice.film_reflectance > 0) look_at(film_ghost_pairs(of_lens));
    make_crossings(lens, spectrum);
    if (is_round_lens(of_lens))
        find_lens_paths(EntrancePupilSearch<FilmRings>(of_lens, film_radius, tracer), of_lens, lens, pairs,
                        choice.least_share, tracer);
    else
        find_lens_paths(EntrancePupilSearch<FilmCells>(of_lens, film_radius, tracer), of_lens, lens, pairs,
                        choice.least_share, tracer);
    set_probabilities();
    const LensPath<float> straight(of_lens, LightDirection::to_film, lens.wavelength_nm);
    iris_ = straight.view().iris;
    kind_ = is_round_lens(of_lens) ? straight.view().kind : LensKind::any;
}

template <class Map>
void GhostTables::find_lens_paths(const EntrancePupilSearch<Map>& search, const LensSystem& of_lens,
                                  const LensSystem& lens, const std::vector<AxialPair>& pairs, double least_share,
                                  const PupilTracer& tracer) {
    FoundRays found(pairs.size() + 1);  // the last element: the lens's direct path
    tracer.for_each(static_cast<int>(found.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        const auto crossings = k < pairs.size() ? crossings_of(of_lens, pairs[k].pair) : crossings_of(of_lens);
        found[k] = search.along(lens, crossings);
    });
    const auto directions = Map::directions_of(found);
    set_maps(directions, search.map());
    entry_reach_ = entry_reach(of_lens);
    exit_reach_ = static_cast<float>(search.map().rear_reach);
    const auto append = [](std::vector<GhostEntry>& to, const std::vector<GhostEntry>& entries) {
        to.insert(to.end(), entries.begin(), entries.end());
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double share = pairs[k].share * etendue_of(found[k]) / etendue_of(found.back());
        if (!(share > least_share)) continue;
        pairs_.push_back(pairs[k].pair);
        shares_.push_back(share);
        const std::vector<Crossing> crossings = crossings_of(of_lens, pairs[k].pair);
        const auto path = [&](LightDirection direction) {
            return LensPath<float>(lens, crossings, direction, lens.wavelength_nm, film_path_ends(of_lens, direction));
        };
        add(to_film_, path(LightDirection::to_film), crossings);
        add(to_scene_, path(LightDirection::to_scene), reversed(crossings));
        append(to_film_.entries, entries_of<Map>(found[k], directions));
        append(to_scene_.entries, exits_of<Map>(found[k]));
    }
}

GhostView GhostTables::view_of_objects() const {
    double share = 0;
    for (const double of_pair : shares_) share += of_pair;
    const auto samples = static_cast<std::int32_t>(std::clamp(0.5 / share, 16.0, 256.0));
    return view_of(to_scene_, GhostLight::of_objects, samples, exit_reach_, film_grid_);
}

GhostView GhostTables::view_of(const LensPaths& of, GhostLight light, std::int32_t pixel_samples, float reach,
                               const GhostGrid& grid) const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    return {light,
            effects_,
            pixel_samples,
            of.paths.data(),
            static_cast<int>(of.paths.size()),
            cdf_.data(),
            data_of(of.entries),
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
            kind_,
            grid,
            {data_of(of.frames), data_of(of.freeforms), data_of(of.apertures)}};
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
    for (LensPaths* of : {&to_film_, &to_scene_})
        for (std::size_t k = 0; k < weights.size(); ++k) of->paths[k].probability = cdf_[k + 1] - cdf_[k];
}

}  // namespace realcam
