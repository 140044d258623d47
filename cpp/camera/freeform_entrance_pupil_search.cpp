#include "freeform_entrance_pupil_search.hpp"

#include <algorithm>
#include <cmath>

#include "../math/hypotenuse.hpp"
#include "../math/random.hpp"
#include "entrance_pupil_search.hpp"

namespace realcam {

namespace {

/// Visits a cell of a grid and its neighbours.
template <class Visit>
void for_neighbours(int cell, Visit&& visit) {
    const int column = cell % kGhostColumns, row = cell / kGhostColumns;
    for (int y = std::max(0, row - 1); y <= std::min(kGhostColumns - 1, row + 1); ++y)
        for (int x = std::max(0, column - 1); x <= std::min(kGhostColumns - 1, column + 1); ++x)
            visit(y * kGhostColumns + x);
}

/// Bounding rectangles of the points of each cell and its neighbours. A margin of a sixteenth on each side covers the
/// gaps between the rays.
template <class CellOf>
std::vector<FreeGhostEntry> entries_around(const std::vector<FreeFoundRay>& rays, Vec2f FreeFoundRay::* place,
                                           CellOf&& cell_of) {
    struct Box {
        Vec2f low = {0, 0}, high = {0, 0};
        bool is_known = false;

        void take_in(Vec2f least, Vec2f most) {
            low = is_known ? Vec2f{std::min(low.x, least.x), std::min(low.y, least.y)} : least;
            high = is_known ? Vec2f{std::max(high.x, most.x), std::max(high.y, most.y)} : most;
            is_known = true;
        }
    };
    std::array<Box, kGhostCells> own;
    for (const FreeFoundRay& ray : rays) {
        const int cell = cell_of(ray);
        if (cell >= 0) own[static_cast<std::size_t>(cell)].take_in(ray.*place, ray.*place);
    }
    std::vector<FreeGhostEntry> entries(kGhostCells);
    for (int cell = 0; cell < kGhostCells; ++cell) {
        Box box;
        for_neighbours(cell, [&](int beside) {
            const Box& other = own[static_cast<std::size_t>(beside)];
            if (other.is_known) box.take_in(other.low, other.high);
        });
        if (!box.is_known) continue;
        const float half_width = 0.5f * (box.high.y - box.low.y);
        // Positive, because 0 marks an empty entry.
        const float margin = std::max(0.0625f * std::max(box.high.x - box.low.x, half_width), 1e-6f);
        FreeGhostEntry& entry = entries[static_cast<std::size_t>(cell)];
        entry.low = box.low.x - margin;
        entry.high = box.high.x + margin;
        entry.half_width = half_width + margin;
        entry.across = 0.5f * (box.low.y + box.high.y);
    }
    return entries;
}

}  // namespace

FreeformEntrancePupilSearch::FreeformEntrancePupilSearch(const LensSystem& lens, double film_radius,
                                                         const PupilTracer& tracer)
    : lens_(lens),
      to_scene_(film_path_ends(lens, LightDirection::to_scene)),
      film_{static_cast<float>(lens.film_distance), static_cast<float>(1 / lens.film_radius_of_curvature)},
      cell_size_(static_cast<float>(2 * film_radius / kGhostColumns)),
      film_index_(static_cast<float>(lens.indices(lens.wavelength_nm).back())),
      tracer_(tracer) {
    const auto corner = static_cast<float>(-film_radius), cells = 1 / cell_size_;
    film_grid_ = {{corner, corner}, {cells, cells}};
    front_reach_ = entry_reach(lens);
    // Between the last surface and the plane z = 0, a ray covers at most this fraction (`share`) of its distance to the
    // film.
    const Surface& last = lens.surfaces.back();
    Affine<double> rear{};  // a surface that is not displaced lies at the origin
    if (to_scene_.entry) rear = inverse_motion(*to_scene_.entry) * surface_frames(lens).surfaces.back();
    const double rim = last.clear_semi_diameter, beside = hypotenuse(rear.origin.x, rear.origin.y) + reach_of(last);
    const double depth = std::fabs(rear.origin.z) + rim_depth(last) + rim * hypotenuse(rear.z.x, rear.z.y);
    const double share = depth / std::max(lens.film_distance - depth, 0.1 * lens.film_distance);
    rear_reach_ = static_cast<float>(beside + share * (beside + film_radius));
}

std::vector<FreeFoundRay> FreeformEntrancePupilSearch::along(const LensSystem& lens,
                                                             const std::vector<Crossing>& way) const {
    const LensSystem round = with_stop_around_blades(lens);
    LensSystem open = round;
    open.stop_semi_diameter = open.stop().clear_semi_diameter;
    Rears rears;
    rears.fill({{-rear_reach_, -rear_reach_}, {rear_reach_, rear_reach_}});
    rears = around(traced<kFew>(open, way, rears), rears);
    rears = around(traced<kFew>(round, way, rears), rears);
    return traced<kMany>(round, way, rears);
}

template <int kRows>
std::vector<FreeFoundRay> FreeformEntrancePupilSearch::traced(const LensSystem& lens, const std::vector<Crossing>& way,
                                                              const Rears& rears) const {
    constexpr int kPerCell = kRows * kRows, kCount = kGhostCells * kPerCell;
    static_assert(kCount % PupilTracer::kBlock == 0);
    const LensPath<float> back(lens, way, LightDirection::to_scene, lens.wavelength_nm, to_scene_);
    std::vector<FreeFoundRay> found;
    for (int first = 0; first < kCount; first += PupilTracer::kBlock) {
        PupilTracer::Rays rays;
        FreeFoundRay looked[PupilTracer::kBlock];
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            const int cell = (first + k) / kPerCell, square = (first + k) % kPerCell;
            // Random point in the film cell, and stratified point in its rectangle of the rear plane.
            const auto number = static_cast<std::uint32_t>(first + k);
            const Vec2f u = sample_2d(0, number, 0), v = sample_2d(0, number, 1);
            const Vec2f at = {film_grid_.corner.x + cell_size_ * (static_cast<float>(cell % kGhostColumns) + u.x),
                              film_grid_.corner.y + cell_size_ * (static_cast<float>(cell / kGhostColumns) + u.y)};
            const Rectangle& in = rears[static_cast<std::size_t>(cell)];
            FreeFoundRay& ray = looked[k];
            ray.film_cell = cell;
            ray.rear_step = {(in.high.x - in.low.x) / kRows, (in.high.y - in.low.y) / kRows};
            ray.rear = {in.low.x + (static_cast<float>(square % kRows) + v.x) * ray.rear_step.x,
                        in.low.y + (static_cast<float>(square / kRows) + v.y) * ray.rear_step.y};
            const Vec3f from = film_.place(at), to = Vec3f{ray.rear.x, ray.rear.y, 0} - from;
            const float squared = dot(to, to), cosines = -to.z * dot(to, film_.direction(at, {0, 0, -1})) / squared;
            ray.etendue = cosines / squared * cell_size_ * cell_size_ * ray.rear_step.x * ray.rear_step.y;
            rays.origin.set(k, from);
            rays.direction.set(k, film_index_ * normalized(to));
            rays.status[k] = cosines > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        tracer_.trace(back.view(), rays);
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            const Vec3f origin = rays.origin[k], direction = normalized(rays.direction[k]);
            const LightAxes axes = light_axes(direction);
            looked[k].half_tangents = half_tangents(direction);
            looked[k].front = {dot(origin, axes.x), dot(origin, axes.y)};
            found.push_back(looked[k]);
        }
    }
    return found;
}

FreeformEntrancePupilSearch::Rears FreeformEntrancePupilSearch::around(const std::vector<FreeFoundRay>& rays,
                                                                       const Rears& before) {
    struct Own {
        Rectangle in;
        bool is_known = false;
    };
    std::array<Own, kGhostCells> own;
    const auto unite = [](Own& a, const Rectangle& b) {
        a.in = !a.is_known ? b
                           : Rectangle{{std::min(a.in.low.x, b.low.x), std::min(a.in.low.y, b.low.y)},
                                       {std::max(a.in.high.x, b.high.x), std::max(a.in.high.y, b.high.y)}};
        a.is_known = true;
    };
    for (const FreeFoundRay& ray : rays) {
        const float wide = 1.5f * ray.rear_step.x, high = 1.5f * ray.rear_step.y;
        unite(own[static_cast<std::size_t>(ray.film_cell)],
              {{ray.rear.x - wide, ray.rear.y - high}, {ray.rear.x + wide, ray.rear.y + high}});
    }
    Rears around = before;
    for (int cell = 0; cell < kGhostCells; ++cell) {
        Own here;
        for_neighbours(cell, [&](int beside) {
            const Own& other = own[static_cast<std::size_t>(beside)];
            if (other.is_known) unite(here, other.in);
        });
        if (here.is_known) around[static_cast<std::size_t>(cell)] = here.in;
    }
    return around;
}

std::vector<FreeGhostEntry> FreeformEntrancePupilSearch::entries_of(const std::vector<FreeFoundRay>& rays,
                                                                    const GhostGrid& directions) {
    return entries_around(rays, &FreeFoundRay::front,
                          [&](const FreeFoundRay& ray) { return directions.cell_of(ray.half_tangents); });
}

std::vector<FreeGhostEntry> FreeformEntrancePupilSearch::exits_of(const std::vector<FreeFoundRay>& rays) {
    return entries_around(rays, &FreeFoundRay::rear, [](const FreeFoundRay& ray) { return ray.film_cell; });
}

GhostGrid grid_of_directions(const std::vector<std::vector<FreeFoundRay>>& rays) {
    Vec2f low = {1e9f, 1e9f}, high = {-1e9f, -1e9f};
    for (const std::vector<FreeFoundRay>& found : rays)
        for (const FreeFoundRay& ray : found) {
            const auto [x, y] = ray.half_tangents;
            low = {std::min(low.x, x), std::min(low.y, y)};
            high = {std::max(high.x, x), std::max(high.y, y)};
        }
    if (!(high.x > low.x && high.y > low.y)) return {{0, 0}, {0, 0}};
    // A margin of half a cell on each side covers the gaps between the rays.
    const auto cells = [](float least, float most) { return (kGhostColumns - 1) / (most - least); };
    const Vec2f scale = {cells(low.x, high.x), cells(low.y, high.y)};
    return {{low.x - 0.5f / scale.x, low.y - 0.5f / scale.y}, scale};
}

double etendue_of(const std::vector<FreeFoundRay>& rays) {
    double sum = 0;
    for (const FreeFoundRay& ray : rays) sum += static_cast<double>(ray.etendue);
    return sum;
}

}  // namespace realcam
