#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "../math/append_cdf.hpp"
#include "../optics/fit_coatings.hpp"
#include "../optics/ghost.hpp"
#include "../optics/pupil_tracer.hpp"
#include "film_spectrum.hpp"
#include "ghost_view.hpp"

namespace REALCAM_NAMESPACE {

namespace ghost_tables_detail {

/// The largest angle between light and axis that is looked at.
inline constexpr double kLargestAngle = 125 * std::numbers::pi / 180;

/// Where, on a grid across the light, rays of one direction reach the film.
struct EntryGrid {
    static constexpr int kCells = 24;  ///< on each side of the axis

    GhostEntry box{0, 0, 0};
    int hits = 0;

    void include(Vec2f at, float cell) {
        if (hits++ == 0) box = {at.x - cell, at.x + cell, at.y + cell};
        box.low = std::min(box.low, at.x - cell);
        box.high = std::max(box.high, at.x + cell);
        box.half_width = std::max(box.half_width, at.y + cell);
    }
};

inline GhostEntry united(const GhostEntry& a, const GhostEntry& b) {
    if (a.half_width == 0) return b;
    if (b.half_width == 0) return a;
    return {std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.half_width, b.half_width)};
}

/// What the search for entries needs of lens and film.
struct EntrySearch {
    float reach;  ///< GhostView::reach
    float film_distance, film_radius;
    const PupilTracer& tracer;

    /// Rays at this angle to the axis. Lens and circle of film are round, so that half of the grid is enough.
    EntryGrid at(const LensView<float>& way, double angle) const {
        constexpr int kColumns = 2 * EntryGrid::kCells, kCount = kColumns * EntryGrid::kCells;
        const float sine = static_cast<float>(std::sin(angle)), cosine = static_cast<float>(std::cos(angle));
        const float cell = reach / EntryGrid::kCells;
        EntryGrid grid;
        const auto place = [&](int i) {
            return Vec2f{(static_cast<float>(i % kColumns) + 0.5f) * cell - reach,
                         (static_cast<float>(i / kColumns) + 0.5f) * cell};
        };
        for (int first = 0; first < kCount; first += PupilTracer::kBlock) {
            PupilTracer::Rays rays;
            for (int k = 0; k < PupilTracer::kBlock; ++k) {
                const Vec2f at = place(std::min(first + k, kCount - 1));
                rays.origin.set(k, {at.x * cosine, at.y, at.x * sine});
                rays.direction.set(k, {-sine, 0, cosine});
                rays.status[k] = 0;
            }
            tracer.trace(way, rays);
            for (int k = 0; k < PupilTracer::kBlock && first + k < kCount; ++k)
                if (rays.status[k] == 0 && is_on_film(rays.origin[k], rays.direction[k]))
                    grid.include(place(first + k), cell);
        }
        return grid;
    }

private:
    bool is_on_film(Vec3f o, Vec3f d) const {
        const float t = (film_distance - o.z) / d.z, x = o.x + t * d.x, y = o.y + t * d.y;
        return x * x + y * y <= film_radius * film_radius;
    }
};

/// What a way's ghosts bring to the film, and where the light enters.
struct Entries {
    std::array<GhostEntry, kGhostAngles> boxes;
    double flux;  ///< mean area through which light enters, over all directions of a half-space, mm^2
};

inline Entries entries_of(const EntrySearch& search, const LensView<float>& way, double largest_angle) {
    Entries entries{};
    const double step = largest_angle / kGhostAngles, cell = static_cast<double>(search.reach) / EntryGrid::kCells;
    EntryGrid last = search.at(way, 0);
    for (int i = 0; i < kGhostAngles; ++i) {
        const EntryGrid next = search.at(way, (i + 1) * step);
        entries.boxes[static_cast<std::size_t>(i)] = united(last.box, next.box);
        entries.flux += 2 * cell * cell * next.hits * std::sin((i + 1) * step) * step;
        last = next;
    }
    return entries;
}

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
        const Surface& front = lens.surfaces.front();
        reach_ = static_cast<float>(1.02 * std::hypot(front.clear_semi_diameter, front.sag(front.clear_semi_diameter)));
        const EntrySearch search{reach_, static_cast<float>(lens.film_distance), static_cast<float>(film_radius),
                                 tracer};
        const std::vector<GhostPair> pairs = ghost_pairs(lens);
        std::vector<LensPath<float>> ways;
        for (const GhostPair pair : pairs)
            ways.emplace_back(lens, crossings_of(lens, pair), LightDirection::to_film, lens.wavelength_nm);
        largest_angle_ = 0;
        find_largest_angle(search, ways);
        std::vector<Entries> entries(pairs.size());
        tracer.for_each(static_cast<int>(pairs.size()), [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            entries[k] = entries_of(search, ways[k].view(), static_cast<double>(largest_angle_));
        });
        const LensPath<float> straight(lens, LightDirection::to_film, lens.wavelength_nm);
        const double whole = entries_of(search, straight.view(), static_cast<double>(largest_angle_)).flux;
        make_crossings(lens, spectrum);
        std::vector<double> shares;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const double share = entries[k].flux * axial_share(lens, pairs[k]) / whole;
            if (!(share > least_share)) continue;
            shares.push_back(share);
            add(lens, pairs[k], ways[k].view(), entries[k]);
        }
        set_probabilities(shares);
        const LensView<float> view = straight.view();
        iris_ = view.iris;
        kind_ = view.kind;
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
                largest_angle_,
                reach_,
                iris_,
                kind_};
    }

    const std::vector<GhostPair>& pairs() const { return pairs_; }

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

    void find_largest_angle(const ghost_tables_detail::EntrySearch& search, const std::vector<LensPath<float>>& ways) {
        constexpr double kStep = 5 * std::numbers::pi / 180;
        std::vector<double> largest(ways.size(), kStep);
        search.tracer.for_each(static_cast<int>(ways.size()), [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            double angle = ghost_tables_detail::kLargestAngle;
            while (angle > kStep && search.at(ways[k].view(), angle).hits == 0) angle -= kStep;
            largest[k] = angle + kStep;
        });
        for (const double angle : largest) largest_angle_ = std::max(largest_angle_, static_cast<float>(angle));
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

    void add(const LensSystem& lens, GhostPair pair, const LensView<float>& way,
             const ghost_tables_detail::Entries& entries) {
        pairs_.push_back(pair);
        ways_.push_back({static_cast<std::int32_t>(surfaces_.size()), way.count, 0});
        surfaces_.insert(surfaces_.end(), way.surfaces, way.surfaces + way.count);
        entries_.insert(entries_.end(), entries.boxes.begin(), entries.boxes.end());
        for (const Crossing& crossing : crossings_of(lens, pair)) {
            const std::size_t number = ghost_tables_detail::number_of(crossing);
            if (!all_coatings_.empty()) coatings_.push_back(all_coatings_[number]);
            if (all_indices_.empty()) continue;
            indices_.push_back(all_indices_[number]);
            spectral_coatings_.push_back(all_spectral_[number]);
        }
    }

    /// By what the ways bring to the film; a tenth without regard to it, because light comes from one side.
    void set_probabilities(const std::vector<double>& shares) {
        if (shares.empty()) return;
        double sum = 0;
        for (const double share : shares) sum += share;
        std::vector<double> weights;
        for (const double share : shares)
            weights.push_back(0.9 * share / sum + 0.1 / static_cast<double>(shares.size()));
        append_cdf(weights, cdf_);
        for (std::size_t k = 0; k < ways_.size(); ++k) ways_[k].probability = cdf_[k + 1] - cdf_[k];
    }

    std::vector<GhostPair> pairs_;
    std::vector<GhostWay> ways_;
    std::vector<float> cdf_;
    std::vector<GhostEntry> entries_;
    std::vector<SurfaceView<float>> surfaces_;
    std::vector<GhostCoating<kOneWavelengthTerms>> coatings_, all_coatings_;
    std::vector<IndexCubic> indices_, all_indices_;
    std::vector<GhostCoating<kSpectrumTerms>> spectral_coatings_, all_spectral_;
    Crossings all_;  ///< of which the all_... are, by ghost_tables_detail::number_of
    float largest_angle_ = 0, reach_ = 0;
    Iris<float> iris_{};
    LensKind kind_ = LensKind::any;
};

}  // namespace REALCAM_NAMESPACE
