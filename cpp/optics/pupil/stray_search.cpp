#include "stray_search.hpp"

#include <algorithm>
#include <cmath>

#include "../../math/random.hpp"

namespace realcam {

StraySearch::Traced StraySearch::widen(const PupilLens& lens, const SetRays& set_rays, PupilHalves& halves) const {
    Traced traced;
    const bool is_symmetric = halves.size() == 1;
    for (int round = 0, clean_in_succession = 0; round < max_rounds && clean_in_succession < clean_rounds; ++round) {
        const std::uint32_t stream = static_cast<std::uint32_t>(max_rounds) * cell + static_cast<std::uint32_t>(round);
        const bool is_beside = round % 2 != 0;
        const Points points = is_beside ? points_beside(stream, halves) : points_all_over(stream, is_symmetric);
        PupilRays rays;
        set_rays(round, stream, points, rays);
        bool passes[kBlock], found_stray = false;
        lens.trace(rays, passes);
        for (int i = 0; i < kBlock; ++i) {
            if (!passes[i]) continue;
            const Vec2f point = points[i];
            found_stray |= is_symmetric ? halves[0].extend_to(point)
                                        : halves[point.y < 0].extend_to({point.x, std::fabs(point.y)});
        }
        (is_beside ? traced.passed_beside : traced.passed_all_over) +=
            static_cast<int>(std::count(passes, passes + kBlock, true));
        if (!is_beside) traced.all_over += kBlock;
        clean_in_succession = found_stray ? 0 : clean_in_succession + 1;
    }
    return traced;
}

StraySearch::Points StraySearch::points_all_over(std::uint32_t stream, bool is_symmetric) const {
    const auto size = static_cast<float>(half_size);
    Points points;
    for (int i = 0; i < kBlock; ++i) {
        const Vec2f u = sample_2d(stream, static_cast<std::uint32_t>(i), dimension);
        points.set(i, {size * (2 * u.x - 1), size * (is_symmetric ? u.y : 2 * u.y - 1)});
    }
    return points;
}

StraySearch::Points StraySearch::points_beside(std::uint32_t stream, const PupilHalves& halves) const {
    const bool is_symmetric = halves.size() == 1;
    Points points;
    for (std::size_t i = 0; i < kBlock; ++i) {
        const Vec2f u = sample_2d(stream, static_cast<std::uint32_t>(i), dimension);
        const std::size_t half = is_symmetric ? 0 : i % 2, sector = (is_symmetric ? i : i / 2) % PupilRow::kSectors;
        const Vec2f point = halves[half].sample_beside(sector, u);
        points.set(static_cast<int>(i), {point.x, half == 0 ? point.y : -point.y});
    }
    return points;
}

}  // namespace realcam
