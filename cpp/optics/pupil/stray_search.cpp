#include "stray_search.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/random.hpp"

namespace realcam {

StraySearch::Traced StraySearch::widen(const PupilLens& lens, const SetRays& set_rays, PupilHalves& halves) const {
    Traced traced;
    const bool is_symmetric = halves.size() == 1;
    for (int round = 0, clean = 0; round < most_rounds && clean < clean_rounds; ++round) {
        const std::uint32_t stream = static_cast<std::uint32_t>(most_rounds) * cell + static_cast<std::uint32_t>(round);
        const bool is_beside = round % 2 != 0;
        const Places places = is_beside ? points_beside(stream, halves) : points_around(stream, is_symmetric);
        PupilRays rays;
        set_rays(round, stream, places, rays);
        bool passes[kBlock], strayed = false;
        lens.trace(rays, passes);
        for (int i = 0; i < kBlock; ++i) {
            if (!passes[i]) continue;
            const Vec2f place = places[i];
            strayed |=
                is_symmetric ? halves[0].take_in(place) : halves[place.y < 0].take_in({place.x, std::fabs(place.y)});
        }
        (is_beside ? traced.beside_passed : traced.around_passed) +=
            static_cast<int>(std::count(passes, passes + kBlock, true));
        if (!is_beside) traced.around += kBlock;
        clean = strayed ? 0 : clean + 1;
    }
    return traced;
}

StraySearch::Places StraySearch::points_around(std::uint32_t stream, bool is_symmetric) const {
    const auto size = static_cast<float>(reach);
    Places places;
    for (int i = 0; i < kBlock; ++i) {
        const Vec2f u = sample_2d(stream, static_cast<std::uint32_t>(i), dimension);
        places.set(i, {size * (2 * u.x - 1), size * (is_symmetric ? u.y : 2 * u.y - 1)});
    }
    return places;
}

StraySearch::Places StraySearch::points_beside(std::uint32_t stream, const PupilHalves& halves) const {
    const bool is_symmetric = halves.size() == 1;
    Places places;
    for (std::size_t i = 0; i < kBlock; ++i) {
        const Vec2f u = sample_2d(stream, static_cast<std::uint32_t>(i), dimension);
        const std::size_t half = is_symmetric ? 0 : i % 2, sector = (is_symmetric ? i : i / 2) % PupilRow::kSectors;
        const Vec2f place = halves[half].beside(sector, u);
        places.set(static_cast<int>(i), {place.x, half == 0 ? place.y : -place.y});
    }
    return places;
}

}  // namespace realcam
