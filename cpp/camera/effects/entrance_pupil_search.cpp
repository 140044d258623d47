#include "entrance_pupil_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "../../math/hypotenuse.hpp"
#include "../../math/random.hpp"
#include "../../optics/trace/film_frame.hpp"
#include "../../optics/trace/lens_path.hpp"
#include "../../optics/trace/open_iris.hpp"

namespace realcam {

namespace {

/// Largest distance of a surface's rim from its vertex plane, mm.
double rim_depth(const Surface& surface) {
    const double r = surface.clear_semi_diameter;
    double depth = 0;
    for (const double sag : {surface.sag(0, r), surface.sag(0, -r), surface.sag(r, 0), surface.sag(-r, 0)})
        if (std::isfinite(sag)) depth = std::max(depth, std::fabs(sag));
    return depth;
}

/// Radius of a circle in the vertex plane through which all light passes that hits the surface, mm.
double light_radius(const Surface& surface) {
    constexpr double kMargin = 1.02;
    return kMargin * hypotenuse(surface.clear_semi_diameter, rim_depth(surface));
}

/// The lens with a circular stop: the circumcircle of the opening that its blades leave.
LensSystem with_stop_around_blades(LensSystem lens) {
    if (lens.iris.blades == 0 || lens.is_wide_open()) return lens;
    const double rim = lens.stop().clear_semi_diameter;
    const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
    const double corner = opening_radius(open.apothem, open.curvature, std::cos(std::numbers::pi / lens.iris.blades));
    lens.stop_semi_diameter = std::min(corner, rim);
    lens.iris.blades = 0;
    return lens;
}

/// Enlarges a rectangle, std::nullopt being the empty one, to contain another.
template <class T>
void enlarge(std::optional<TargetRectangle<T>>& a, const TargetRectangle<T>& b) {
    if (!a) a = b;
    a = {{std::min(a->low.x, b.low.x), std::min(a->low.y, b.low.y)},
         {std::max(a->high.x, b.high.x), std::max(a->high.y, b.high.y)}};
}

/// Bounds, for each cell of a map, of the bounds `own` of the cell and its neighbours.
template <class Map, class Bounds>
std::vector<std::optional<Bounds>> with_neighbours(const std::vector<std::optional<Bounds>>& own) {
    constexpr int kColumns = Map::kColumns, kRows = Map::kRows;
    std::vector<std::optional<Bounds>> all(own.size());
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
            for (int y = std::max(0, row - 1); y <= std::min(kRows - 1, row + 1); ++y)
                for (int x = std::max(0, column - 1); x <= std::min(kColumns - 1, column + 1); ++x)
                    if (const auto& other = own[static_cast<std::size_t>(y * kColumns + x)])
                        enlarge(all[static_cast<std::size_t>(row * kColumns + column)], *other);
    return all;
}

/// Bounding rectangles of points of rays, for each cell and its neighbours. `point_of`: the points, as a member of
/// FoundRay; `cell_of(ray)`: index of a ray's cell, negative if there is none. A margin of a sixteenth on each side
/// covers the gaps between the rays.
template <class Map, class CellOf>
std::vector<GhostBounds> entries_around(const std::vector<FoundRay>& rays, Vec2f FoundRay::* point_of,
                                        CellOf&& cell_of) {
    std::vector<std::optional<TargetRectangle<float>>> own(Map::kColumns * Map::kRows);
    for (const FoundRay& ray : rays) {
        const int cell = cell_of(ray);
        const Vec2f point = ray.*point_of, mirrored = {point.x, Map::kMirrored ? -point.y : point.y};
        if (cell < 0) continue;
        enlarge(own[static_cast<std::size_t>(cell)], {point, point});
        enlarge(own[static_cast<std::size_t>(cell)], {mirrored, mirrored});
    }
    std::vector<GhostBounds> entries;
    for (const auto& box : with_neighbours<Map>(own)) {
        GhostBounds& entry = entries.emplace_back();
        if (!box) continue;
        const float half_width = 0.5f * (box->high.y - box->low.y);
        // Positive, because 0 marks an empty entry.
        const float margin = std::max(0.0625f * std::max(box->high.x - box->low.x, half_width), 1e-6f);
        entry = {box->low.x - margin, box->high.x + margin, half_width + margin, 0.5f * (box->low.y + box->high.y)};
    }
    return entries;
}

}  // namespace

float entry_reach(const LensSystem& lens) {
    Affine<double> front = surface_frames(lens).surfaces.front();
    if (const auto camera = film_path_ends(lens, LightDirection::to_scene).exit)
        front = inverse_motion(*camera) * front;
    return static_cast<float>(length(front.origin) + light_radius(lens.surfaces.front()));
}

int HalfTangentBins::bin_of(float half_tangent) const {
    return std::clamp(static_cast<int>(half_tangent / largest * static_cast<float>(kGhostBins)), 0, kGhostBins - 1);
}

FilmRings::FilmRings(const LensSystem& lens, double film_radius)
    : film_radius(film_radius),
      film_distance(lens.film_distance),
      film_index(lens.indices(lens.wavelength_nm).back()),
      rear_reach(light_radius(lens.surfaces.back())) {}

TargetRectangle<double> FilmRings::all_targets(int ring) const {
    const double r = radius_of(ring);
    const auto cosine_to = [&](double away) { return away / hypotenuse(away, film_distance); };
    return {{cosine_to(-rear_reach - r), 0}, {cosine_to(rear_reach - r), cosine_to(rear_reach)}};
}

void FilmRings::start(const TargetRectangle<double>& in, const TargetStratum<double>& stratum, int lane,
                      PupilTracer::Rays& rays, FoundRay& ray) const {
    const double r = radius_of(ray.film_cell), ring = film_radius / kGhostBins;
    const double x = in.low.x + (stratum.column + 0.5) * stratum.size.x, y = (stratum.row + 0.5) * stratum.size.y;
    const double z2 = 1 - x * x - y * y, z = std::sqrt(std::max(z2, 0.0));
    rays.origin.set(lane, static_cast<Vec3f>(Vec3d{r, 0, film_distance}));
    rays.direction.set(lane, static_cast<Vec3f>(film_index * Vec3d{x, y, -z}));
    rays.status[lane] = z2 > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
    ray.target = {static_cast<float>(x), static_cast<float>(y)};
    ray.rear = {static_cast<float>(r + x / z * film_distance), static_cast<float>(y / z * film_distance)};
    // The first factor of 2 accounts for the other half of the circle.
    ray.etendue = static_cast<float>(2 * 2 * std::numbers::pi * r * ring * stratum.size.x * stratum.size.y);
}

void FilmRings::set_front(Vec3f o, Vec3f d, FoundRay& ray) {
    const float sine = std::sqrt(d.x * d.x + d.y * d.y);
    const Vec2f away = sine > 0 ? Vec2f{d.x / sine, d.y / sine} : Vec2f{1, 0};
    ray.half_tangents = {sine / (1 - d.z), 0};
    ray.front = {dot(o, Vec3f{-d.z * away.x, -d.z * away.y, sine}), -away.y * o.x + away.x * o.y};
}

HalfTangentBins FilmRings::directions_of(const FoundRays& rays) {
    float largest = 0;
    for (const std::vector<FoundRay>& found : rays)
        for (const FoundRay& ray : found) largest = std::max(largest, ray.half_tangents.x);
    return {largest * (1 + 1.0f / kGhostBins)};
}

FilmCells::FilmCells(const LensSystem& lens, double film_radius)
    : to_scene(film_path_ends(lens, LightDirection::to_scene)),
      film{static_cast<float>(lens.film_distance), static_cast<float>(1 / lens.film_radius_of_curvature)},
      cell_size(static_cast<float>(2 * film_radius / kGhostColumns)),
      film_index(static_cast<float>(lens.indices(lens.wavelength_nm).back())) {
    const auto corner = static_cast<float>(-film_radius), cells = 1 / cell_size;
    grid = {{corner, corner}, {cells, cells}};
    // Between the last surface and the plane z = 0, a ray covers at most this fraction of its distance to the film.
    const Surface& last = lens.surfaces.back();
    Affine<double> rear{};  // a surface that is not displaced lies at the origin
    if (to_scene.entry) rear = inverse_motion(*to_scene.entry) * surface_frames(lens).surfaces.back();
    const double rim = last.clear_semi_diameter, radius = hypotenuse(rear.origin.x, rear.origin.y) + light_radius(last);
    const double depth = std::fabs(rear.origin.z) + rim_depth(last) + rim * hypotenuse(rear.z.x, rear.z.y);
    const double fraction = depth / std::max(lens.film_distance - depth, 0.1 * lens.film_distance);
    rear_reach = static_cast<float>(radius + fraction * (radius + film_radius));
}

void FilmCells::start(const TargetRectangle<float>& in, const TargetStratum<float>& stratum, int lane,
                      PupilTracer::Rays& rays, FoundRay& ray) const {
    // Random point in the film cell, and stratified point in its rectangle of the rear plane.
    const Vec2f u = sample_2d(0, stratum.index, 0), v = sample_2d(0, stratum.index, 1), step = stratum.size;
    const Vec2f at = {grid.corner.x + cell_size * (static_cast<float>(ray.film_cell % kGhostColumns) + u.x),
                      grid.corner.y + cell_size * (static_cast<float>(ray.film_cell / kGhostColumns) + u.y)};
    ray.target = ray.rear = {in.low.x + (static_cast<float>(stratum.column) + v.x) * step.x,
                             in.low.y + (static_cast<float>(stratum.row) + v.y) * step.y};
    const Vec3f from = film.point(at), to = Vec3f{ray.rear.x, ray.rear.y, 0} - from;
    const float squared = dot(to, to), cosines = -to.z * dot(to, film.direction(at, {0, 0, -1})) / squared;
    ray.etendue = cosines / squared * cell_size * cell_size * step.x * step.y;
    rays.origin.set(lane, from);
    rays.direction.set(lane, film_index * normalized(to));
    rays.status[lane] = cosines > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
}

void FilmCells::set_front(Vec3f o, Vec3f d, FoundRay& ray) {
    const LightAxes axes = light_axes(d);
    ray.half_tangents = half_tangents(d);
    ray.front = {dot(o, axes.x), dot(o, axes.y)};
}

GhostGrid FilmCells::directions_of(const FoundRays& rays) {
    std::optional<TargetRectangle<float>> all;
    for (const std::vector<FoundRay>& found : rays)
        for (const FoundRay& ray : found) enlarge(all, {ray.half_tangents, ray.half_tangents});
    if (!all || !(all->high.x > all->low.x && all->high.y > all->low.y)) return {{0, 0}, {0, 0}};
    // A margin of half a cell on each side covers the gaps between the rays.
    const auto cells = [](float least, float most) { return (kGhostColumns - 1) / (most - least); };
    const Vec2f scale = {cells(all->low.x, all->high.x), cells(all->low.y, all->high.y)};
    return {{all->low.x - 0.5f / scale.x, all->low.y - 0.5f / scale.y}, scale};
}

template <class Map>
std::vector<FoundRay> EntrancePupilSearch<Map>::find_rays(const LensSystem& lens,
                                                          const std::vector<Crossing>& crossings) const {
    const LensSystem stopped = with_stop_around_blades(lens);
    LensSystem open = stopped;
    open.stop_semi_diameter = open.stop().clear_semi_diameter;
    Targets targets;
    for (int cell = 0; cell < kCells; ++cell) targets[static_cast<std::size_t>(cell)] = map_.all_targets(cell);
    targets = target_bounds(trace_strata<Map::kCoarseRows>(open, crossings, targets), targets);
    targets = target_bounds(trace_strata<Map::kCoarseRows>(stopped, crossings, targets), targets);
    return trace_strata<Map::kFineRows>(stopped, crossings, targets);
}

template <class Map>
template <int kStrataRows>
std::vector<FoundRay> EntrancePupilSearch<Map>::trace_strata(const LensSystem& lens,
                                                             const std::vector<Crossing>& crossings,
                                                             const Targets& targets) const {
    constexpr int kStrataColumns = Map::kColumnsPerRow * kStrataRows, kPerCell = kStrataColumns * kStrataRows;
    constexpr int kCount = kCells * kPerCell;
    static_assert(kCount % PupilTracer::kBlock == 0);
    const LensPath<float> back(lens, crossings, LightDirection::to_scene, lens.wavelength_nm, map_.ends());
    std::vector<FoundRay> found;
    for (int first = 0; first < kCount; first += PupilTracer::kBlock) {
        PupilTracer::Rays rays;
        FoundRay launched[PupilTracer::kBlock];
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            const int cell = (first + k) / kPerCell, in_cell = (first + k) % kPerCell;
            const Rectangle& in = targets[static_cast<std::size_t>(cell)];
            const Vec2<Real> size = {(in.high.x - in.low.x) / kStrataColumns, (in.high.y - in.low.y) / kStrataRows};
            launched[k].film_cell = cell;
            launched[k].stratum = {static_cast<float>(size.x), static_cast<float>(size.y)};
            map_.start(
                in, {in_cell % kStrataColumns, in_cell / kStrataColumns, size, static_cast<std::uint32_t>(first + k)},
                k, rays, launched[k]);
        }
        tracer_.trace(back.view(), rays);
        for (int k = 0; k < PupilTracer::kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            Map::set_front(rays.origin[k], normalized(rays.direction[k]), launched[k]);
            found.push_back(launched[k]);
        }
    }
    return found;
}

template <class Map>
typename EntrancePupilSearch<Map>::Targets EntrancePupilSearch<Map>::target_bounds(const std::vector<FoundRay>& rays,
                                                                                   const Targets& previous) {
    std::vector<std::optional<Rectangle>> own(kCells);
    for (const FoundRay& ray : rays) {
        const auto x = static_cast<Real>(ray.target.x), y = static_cast<Real>(ray.target.y);
        // A ray's own stratum is half a stratum to each side; one more covers the gaps to its neighbours.
        const Real wide = Real(1.5) * static_cast<Real>(ray.stratum.x),
                   high = Real(1.5) * static_cast<Real>(ray.stratum.y);
        enlarge(own[static_cast<std::size_t>(ray.film_cell)],
                {{x - wide, Map::kMirrored ? 0 : y - high}, {x + wide, y + high}});
    }
    const std::vector<std::optional<Rectangle>> all = with_neighbours<Map>(own);
    Targets result = previous;
    for (std::size_t cell = 0; cell < result.size(); ++cell)
        if (all[cell]) result[cell] = *all[cell];
    return result;
}

template class EntrancePupilSearch<FilmRings>;
template class EntrancePupilSearch<FilmCells>;

template <class Map, class Directions>
std::vector<GhostBounds> entries_of(const std::vector<FoundRay>& rays, const Directions& directions) {
    return entries_around<Map>(rays, &FoundRay::front,
                               [&](const FoundRay& ray) { return directions.cell_of(ray.half_tangents); });
}

template std::vector<GhostBounds> entries_of<FilmRings>(const std::vector<FoundRay>&, const HalfTangentBins&);
template std::vector<GhostBounds> entries_of<FilmCells>(const std::vector<FoundRay>&, const GhostGrid&);

template <class Map>
std::vector<GhostBounds> exits_of(const std::vector<FoundRay>& rays) {
    return entries_around<Map>(rays, &FoundRay::rear, [](const FoundRay& ray) { return ray.film_cell; });
}

template std::vector<GhostBounds> exits_of<FilmRings>(const std::vector<FoundRay>&);
template std::vector<GhostBounds> exits_of<FilmCells>(const std::vector<FoundRay>&);

double etendue_of(const std::vector<FoundRay>& rays) {
    double sum = 0;
    for (const FoundRay& ray : rays) sum += static_cast<double>(ray.etendue);
    return sum;
}

namespace {

/// Rays through the pupil from one azimuth of the film that leave the lens, with half_tangents and front set.
std::vector<FoundRay> rays_through_pupil(const PupilView& pupil, const LensView<float>& lens, double film_radius,
                                         double film_distance, const PupilTracer& tracer) {
    constexpr int kBlock = PupilTracer::kBlock, kSide = 8, kPerRing = kSide * kSide, kRings = kGhostBins;
    constexpr int kBlocks = kRings * kPerRing / kBlock;
    static_assert(kBlocks * kBlock == kRings * kPerRing);
    std::vector<PupilTracer::Rays> blocks(kBlocks);
    tracer.for_each(kBlocks, [&](int block) {
        PupilTracer::Rays& rays = blocks[static_cast<std::size_t>(block)];
        for (int k = 0; k < kBlock; ++k) {
            const int ring = (block * kBlock + k) / kPerRing, index = (block * kBlock + k) % kPerRing;
            const float radius = static_cast<float>(film_radius) * (static_cast<float>(ring) + 0.5f) / kRings;
            const PupilSample sample =
                sample_pupil(pupil, radius, 0, (static_cast<float>(index % kSide) + 0.5f) / kSide,
                             (static_cast<float>(index / kSide) + 0.5f) / kSide);
            rays.origin.set(k, {radius, 0, static_cast<float>(film_distance)});
            rays.direction.set(k, sample.direction);
            rays.status[k] = sample.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        }
        tracer.trace(lens, rays);
    });
    std::vector<FoundRay> found;
    for (const PupilTracer::Rays& rays : blocks)
        for (int k = 0; k < kBlock; ++k) {
            if (rays.status[k] != 0) continue;
            FoundRay ray{};
            FilmRings::set_front(rays.origin[k], normalized(rays.direction[k]), ray);
            found.push_back(ray);
        }
    return found;
}

}  // namespace

PupilEntryBounds::PupilEntryBounds(const PupilView& pupil, const LensView<float>& lens, double film_radius,
                                   double film_distance, const PupilTracer& tracer) {
    const std::vector<FoundRay> found = rays_through_pupil(pupil, lens, film_radius, film_distance, tracer);
    directions_ = FilmRings::directions_of({found});
    entries_ = entries_of<FilmRings>(found, directions_);
}

}  // namespace realcam
