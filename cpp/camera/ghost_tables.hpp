#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "../math/append_cdf.hpp"
#include "../optics/fit_coatings.hpp"
#include "../optics/ghost.hpp"
#include "entry_search.hpp"
#include "film_spectrum.hpp"

namespace REALCAM_NAMESPACE {

namespace ghost_tables_detail {

/// Number of a crossing among all that a ghost's way may have.
inline std::size_t number_of(const Crossing& crossing) {
    return static_cast<std::size_t>(4 * crossing.surface + 2 * crossing.in_order + crossing.is_reflected);
}

inline std::vector<Crossing> all_crossings(const LensSystem& lens) {
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

/// The ghosts of a lens made ready for pictures. Owns the memory of its view.
class GhostTables {
public:
    /// `film_radius`: of a circle that holds the film, mm. `spectrum`: of a picture with dispersion. Ghosts that bring
    /// less than `least_share` of the light that the lens itself brings to the film, from all sides alike, are left
    /// out. Throws InputError where an index is not known.
    GhostTables(const LensSystem& lens, double film_radius, double least_share, const PupilTracer& tracer,
                const FilmSpectrum* spectrum) {
        using namespace ghost_tables_detail;
        reach_ = entry_reach(lens);
        const EntrySearch search(lens, film_radius, tracer);
        std::vector<GhostPair> pairs;
        std::vector<double> axial;
        for (const GhostPair pair : ghost_pairs(lens)) {
            // A way that no more light can take than ten times what the lens itself takes is not worth the search.
            const double share = axial_share(lens, pair);
            if (!(10 * share > least_share)) continue;
            pairs.push_back(pair);
            axial.push_back(share);
        }
        std::vector<std::vector<FoundRay>> found(pairs.size() + 1);  // the last of the lens itself
        tracer.for_each(static_cast<int>(found.size()), [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            const std::vector<Crossing> way = k < pairs.size() ? crossings_of(lens, pairs[k]) : crossings_of(lens);
            found[k] = search.along(LensPath<float>(lens, way, LightDirection::to_scene, lens.wavelength_nm).view());
        });
        for (const std::vector<FoundRay>& rays : found)
            largest_half_tangent_ = std::max(largest_half_tangent_, largest_half_tangent_of(rays));
        make_crossings(lens, spectrum);
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const double share = axial[k] * etendue_of(found[k]) / etendue_of(found.back());
            if (!(share > least_share)) continue;
            shares_.push_back(share);
            add(lens, pairs[k], entries_of(found[k], largest_half_tangent_));
        }
        set_probabilities();
        const LensPath<float> straight(lens, LightDirection::to_film, lens.wavelength_nm);
        iris_ = straight.view().iris;
        kind_ = straight.view().kind;
    }

    GhostView view() const {
        const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
        return {ways_.data(),
                static_cast<int>(ways_.size()),
                cdf_.data(),
                entries_.data(),
                static_cast<int>(surfaces_.size()),
                surfaces_.data(),
                data_of(coatings_),
                data_of(indices_),
                data_of(spectral_coatings_),
                largest_half_tangent_,
                reach_,
                iris_,
                kind_,
                false};
    }

    const std::vector<GhostPair>& pairs() const { return pairs_; }
    /// Of the light that the lens itself brings to the film, from all sides alike: what each pair brings.
    const std::vector<double>& shares() const { return shares_; }

private:
    using Crossings = std::vector<Crossing>;

    /// Of light along the axis: the product of what the surfaces reflect and let pass.
    static double axial_share(const LensSystem& lens, GhostPair pair) {
        const std::vector<double> indices = lens.indices(lens.wavelength_nm);
        double share = 1;
        for (const Crossing& crossing : crossings_of(lens, pair)) {
            const auto index = static_cast<std::size_t>(crossing.surface);
            if (!lens.surfaces[index].bends_light()) continue;
            const CoatedSurface surface =
                coated_surface(lens, index, lens.wavelength_nm,
                               crossing.in_order ? LightDirection::to_film : LightDirection::to_scene, indices);
            const PolarisedResponse response = surface.at(1);
            share *= crossing.is_reflected || surface.is_mirror() ? response.mean_reflectance()
                                                                  : response.mean_transmittance();
        }
        return share;
    }

    /// What light does at each crossing that a way may have.
    void make_crossings(const LensSystem& lens, const FilmSpectrum* spectrum) {
        all_ = ghost_tables_detail::all_crossings(lens);
        const std::vector<double> design = lens.indices(lens.wavelength_nm);
        const auto ghostly = [&](const auto& coatings, const std::vector<IndexCubic>& beyond) {
            using Polynomials = typename std::decay_t<decltype(coatings)>::value_type;
            std::vector<GhostCoating<Polynomials::kTerms>> all;
            for (std::size_t k = 0; k < coatings.size(); ++k) {
                const double n = all_[k].index_before(design);
                all.push_back({coatings[k], beyond[k], static_cast<float>(n * n), all_[k].is_reflected, {}});
            }
            return all;
        };
        const WavelengthRange range =
            spectrum ? spectrum->range() : WavelengthRange{lens.wavelength_nm, lens.wavelength_nm};
        const std::vector<IndexCubic> beyond = index_cubics(lens, all_, range, true);
        if (spectrum) {
            all_indices_ = index_cubics(lens, all_, range);
            all_spectral_ = ghostly(
                fit_coatings<kSpectrumTerms>(lens, all_, spectrum->even_wavelengths(), variable_over(range)), beyond);
        } else {
            all_coatings_ = ghostly(fit_coatings<kOneWavelengthTerms>(lens, all_, {lens.wavelength_nm}), beyond);
        }
    }

    void add(const LensSystem& lens, GhostPair pair, const std::array<GhostEntry, kGhostAngles>& entries) {
        const std::vector<Crossing> crossings = crossings_of(lens, pair);
        const LensPath<float> path(lens, crossings, LightDirection::to_film, lens.wavelength_nm);
        const LensView<float> way = path.view();
        pairs_.push_back(pair);
        ways_.push_back({static_cast<std::int32_t>(surfaces_.size()), way.count, 0});
        surfaces_.insert(surfaces_.end(), way.surfaces, way.surfaces + way.count);
        entries_.insert(entries_.end(), entries.begin(), entries.end());
        for (const Crossing& crossing : crossings) {
            const std::size_t number = ghost_tables_detail::number_of(crossing);
            if (!all_coatings_.empty()) coatings_.push_back(all_coatings_[number]);
            if (all_indices_.empty()) continue;
            indices_.push_back(all_indices_[number]);
            spectral_coatings_.push_back(all_spectral_[number]);
        }
    }

    /// By what the ways bring to the film; a tenth without regard to it, because light comes from one side.
    void set_probabilities() {
        if (shares_.empty()) return;
        double sum = 0;
        for (const double share : shares_) sum += share;
        std::vector<double> weights;
        for (const double share : shares_)
            weights.push_back(0.9 * share / sum + 0.1 / static_cast<double>(shares_.size()));
        append_cdf(weights, cdf_);
        for (std::size_t k = 0; k < ways_.size(); ++k) ways_[k].probability = cdf_[k + 1] - cdf_[k];
    }

    std::vector<GhostPair> pairs_;
    std::vector<double> shares_;
    std::vector<GhostWay> ways_;
    std::vector<float> cdf_;
    std::vector<GhostEntry> entries_;
    std::vector<SurfaceView<float>> surfaces_;
    std::vector<GhostCoating<kOneWavelengthTerms>> coatings_, all_coatings_;
    std::vector<IndexCubic> indices_, all_indices_;
    std::vector<GhostCoating<kSpectrumTerms>> spectral_coatings_, all_spectral_;
    Crossings all_;  ///< of which the all_... are, by ghost_tables_detail::number_of
    float largest_half_tangent_ = 0, reach_ = 0;
    Iris<float> iris_{};
    LensKind kind_ = LensKind::any;
};

}  // namespace REALCAM_NAMESPACE
