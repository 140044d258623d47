#include "direction_search.hpp"

#include <limits>

namespace realcam {

std::optional<DirectionBox> DirectionSearch::look(Vec2<double> film,
                                                  const std::optional<DirectionBox>& expected) const {
    const DirectionBox widest = lens_.box_of_last_surface(film);
    std::optional<DirectionBox> box;
    if (expected) box = find(film, expected->grown(0.4), widest);
    if (!box) box = find(film, widest, widest);
    return box;
}

PupilDirection DirectionSearch::grid_direction(const DirectionBox& box, int point) {
    const double across = (point % kSide + 0.5) / kSide, along = (point / kSide + 0.5) / kSide;
    return {box.l_min + across * (box.l_max - box.l_min), box.m_min + along * (box.m_max - box.m_min)};
}

template <class Trace>
void DirectionSearch::trace_grid(Vec2<double> film, const DirectionBox& box, Trace&& trace) const {
    for (int first = 0; first < kPoints; first += kBlock) {
        PupilRays rays;
        for (int i = 0; i < kBlock; ++i) rays.set(i, film, grid_direction(box, first + i));
        trace(rays, first);
    }
}

DirectionSearch::Passing DirectionSearch::passing(Vec2<double> film, const DirectionBox& search) const {
    Passing seen;
    trace_grid(film, search, [&](const PupilRays& rays, int) {
        bool passes[kBlock];
        lens_.trace(rays, passes);
        for (int i = 0; i < kBlock; ++i) {
            if (!passes[i]) continue;
            ++seen.count;
            seen.box = seen.box.with({rays.l[i], rays.m[i]});
        }
    });
    if (seen.count > 0) seen.box = seen.box.grown_by(2 * search.half_width() / kSide, 2 * search.half_height() / kSide);
    return seen;
}

std::optional<DirectionBox> DirectionSearch::find(Vec2<double> film, DirectionBox search,
                                                  const DirectionBox& widest) const {
    constexpr int kLevels = 6, kEnough = 64;
    for (int level = 0; level < kLevels; ++level) {
        const Passing seen = passing(film, search);
        if (seen.count >= kEnough) return whole(film, seen.box, search, widest);
        const auto nearest = nearest_to_stop(film, search);
        if (!nearest) return std::nullopt;
        search = seen.count > 0 ? seen.box.grown(0.2)
                                : DirectionBox::around(*nearest, search.half_width() / 6, search.half_height() / 6);
    }
    const Passing few = passing(film, search);
    if (few.count == 0) return std::nullopt;
    return whole(film, few.box, search, widest);
}

DirectionBox DirectionSearch::whole(Vec2<double> film, DirectionBox box, DirectionBox search,
                                    const DirectionBox& widest) const {
    constexpr int kMostGrowths = 16;
    for (int i = 0; i < kMostGrowths && !box.lies_in(search, widest); ++i) {
        search = box.grown(0.5);
        const Passing more = passing(film, search);
        if (more.count == 0) break;
        box = more.box;
    }
    return box;
}

std::optional<PupilDirection> DirectionSearch::nearest_to_stop(Vec2<double> film, const DirectionBox& search) const {
    float least = std::numeric_limits<float>::max();
    int nearest = -1;
    trace_grid(film, search, [&](const PupilRays& from, int first) {
        PupilTracer::Rays rays;
        lens_.trace_to_stop(from, rays);
        for (int i = 0; i < kBlock; ++i) {
            const float x = rays.origin.x[i], y = rays.origin.y[i], squared = x * x + y * y;
            if (rays.status[i] != 0 || !(squared < least)) continue;
            least = squared;
            nearest = first + i;
        }
    });
    if (nearest < 0) return std::nullopt;
    return grid_direction(search, nearest);
}

}  // namespace realcam
