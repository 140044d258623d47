#include "projection_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../optics/lens/parabasal.hpp"
#include "../camera_setup.hpp"
#include "centroid_ray.hpp"

namespace realcam {

namespace {

/// Film area united with its mirror images in the lens's planes of symmetry.
FilmArea with_mirror_images(FilmArea area, MirrorPlanes planes) {
    const auto make_symmetric = [](double& least, double& most) {
        most = std::max(std::fabs(least), std::fabs(most));
        least = -most;
    };
    if (planes.x) make_symmetric(area.least.x, area.most.x);
    if (planes.y) make_symmetric(area.least.y, area.most.y);
    return area;
}

}  // namespace

ProjectionGrid::ProjectionGrid(const CameraSetup& setup, ProjectionRay ray, const RayLoop& loop)
    : planes_(mirror_planes(setup.camera().lens)) {
    const LensSystem& lens = setup.camera().lens;
    area_ = with_mirror_images(setup.film_area(), planes_);
    film_z_ = camera_film_position(lens);
    const RaysFromFilm from_film(lens, lens.wavelength_nm);
    const ParabasalRays middle = parabasal_rays(lens, lens.wavelength_nm);
    reference_ = entrance_pupil_centre(middle, from_film.scene_index());
    if (!(length(reference_ - middle.chief.scene) < kFarPupil_mm)) reference_ = middle.chief.scene;
    const PupilGridView pupil = setup.pupil_grid()->view();
    const CentroidRays centroid_rays(lens, lens.focus_distance - film_z_ + reference_.z);
    if (ray == ProjectionRay::chief) {
        const std::vector<ShiftedGrid::Values> nodes = node_values(
            [&](Vec2<double> film) -> std::optional<NodeRay> {
                const double light = CentroidRays::irradiance_of(centroid_rays.bundle(pupil, film));
                if (!(light > 0)) return std::nullopt;
                const std::optional<ChiefRay> chief = chief_ray_of_film_point(from_film, film);
                if (!chief) return std::nullopt;
                return node_ray({chief->scene, -chief->scene_direction}, light, {0, 0});
            },
            loop);
        std::vector<Grid::Values> rays(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) std::copy_n(nodes[i].begin(), kRayValues, rays[i].begin());
        store(std::move(rays));
        return;
    }
    const ShiftedGrid traced(kColumns + 1, kRows + 1,
                             node_values(
                                 [&](Vec2<double> film) -> std::optional<NodeRay> {
                                     const std::optional<CentroidRay> found =
                                         centroid_rays.centroid_ray(centroid_rays.bundle(pupil, film));
                                     if (!found) return std::nullopt;
                                     const Vec2<double> at = found->light_centroid;
                                     return node_ray(found->ray, found->light, {at.x - film.x, at.y - film.y});
                                 },
                                 loop));
    store(rays_by_light_centroid(traced));
}

ProjectionGrid::NodeRay ProjectionGrid::node_ray(const SceneRay& ray, double light, Vec2<double> shift) const {
    const Vec3d from = ray.origin - reference_, direction = normalized(ray.direction);
    const double start = dot(from, direction);
    return {direction, from - start * direction, start, light, shift};
}

Vec2<double> ProjectionGrid::cell_size() const {
    return {(area_.most.x - area_.least.x) / kColumns, (area_.most.y - area_.least.y) / kRows};
}

Vec2<double> ProjectionGrid::film_point(int column, int row) const {
    const Vec2<double> size = cell_size();
    return {area_.least.x + column * size.x, area_.least.y + row * size.y};
}

template <class RayAt>
std::vector<ProjectionGrid::ShiftedGrid::Values> ProjectionGrid::node_values(RayAt&& ray_at,
                                                                             const RayLoop& loop) const {
    const auto is_mirror_image = [&](int column, int row) {
        return (planes_.x && 2 * column < kColumns) || (planes_.y && 2 * row < kRows);
    };
    std::vector<int> independent;  // nodes that are not mirror images of others
    for (int i = 0; i < (kColumns + 1) * (kRows + 1); ++i)
        if (!is_mirror_image(column_of(i), row_of(i))) independent.push_back(i);
    ShiftedGrid::Values none;
    none.fill(std::numeric_limits<double>::quiet_NaN());
    std::vector<ShiftedGrid::Values> nodes(static_cast<std::size_t>((kColumns + 1) * (kRows + 1)), none);
    loop.for_all(independent.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            const int column = column_of(independent[k]), row = row_of(independent[k]);
            const std::optional<NodeRay> ray = ray_at(film_point(column, row));
            if (!ray) continue;
            for (const bool in_x : {false, true})
                for (const bool in_y : {false, true}) {
                    if ((in_x && !planes_.x) || (in_y && !planes_.y)) continue;
                    const double x = in_x ? -1 : 1, y = in_y ? -1 : 1;
                    const auto& [d, foot, start, light, shift] = *ray;
                    const int at = (in_y ? kRows - row : row) * (kColumns + 1) + (in_x ? kColumns - column : column);
                    nodes[static_cast<std::size_t>(at)] = {x * d.x, y * d.y, d.z,   x * foot.x,  y * foot.y,
                                                           foot.z,  start,   light, x * shift.x, y * shift.y};
                }
        }
    });
    return nodes;
}

std::vector<ProjectionGrid::Grid::Values> ProjectionGrid::rays_by_light_centroid(const ShiftedGrid& traced) const {
    constexpr int kMaxIterations = 20;
    const Vec2<double> size = cell_size();
    std::vector<Grid::Values> rays;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) {
            // Fixed-point iteration: the light's centroid lies a small fraction of a cell from its film point.
            Vec2<double> at = {static_cast<double>(column), static_cast<double>(row)};
            ShiftedGrid::Values values = traced.node(column, row);
            for (int i = 0; i < kMaxIterations; ++i) {
                const Vec2<double> next = {column - values[kRayValues] / size.x, row - values[kRayValues + 1] / size.y};
                const double change = std::fabs(next.x - at.x) + std::fabs(next.y - at.y);
                at = next;
                const ShiftedGrid::Values found = traced.at(at.x, at.y).value;
                // Next to a node without light, the node's own ray is used.
                if (!(change > 1e-12) || !std::isfinite(found[0])) break;
                values = found;
            }
            Grid::Values& ray = rays.emplace_back();
            std::copy_n(values.begin(), kRayValues, ray.begin());
            ray[kLight] = traced.node(column, row)[kLight];
        }
    return rays;
}

void ProjectionGrid::store(std::vector<Grid::Values> rays) {
    const Vec2<double> size = cell_size();
    const double column = std::clamp(-area_.least.x / size.x, 0.0, static_cast<double>(kColumns));
    const double row = std::clamp(-area_.least.y / size.y, 0.0, static_cast<double>(kRows));
    double centre_light = Grid(kColumns + 1, kRows + 1, rays).at(column, row).value[kLight];
    if (!(centre_light > 0)) {  // relative to the brightest node instead
        centre_light = 0;
        for (const Grid::Values& ray : rays) centre_light = std::max(centre_light, ray[kLight]);
    }
    for (Grid::Values& ray : rays) {
        ends_in_film_ |= !std::isfinite(ray[kLight]);
        ray[kLight] /= centre_light;
    }
    rays_.emplace(kColumns + 1, kRows + 1, rays);
}

// Film points of the interface have the axes of the developed picture; the grid has those of the lens, which inverts
// it.
std::optional<FilmProjection> ProjectionGrid::ray(Vec2<double> film) const {
    const Vec2<double> size = cell_size();
    const double column = (-film.x - area_.least.x) / size.x, row = (-film.y - area_.least.y) / size.y;
    // Margin that keeps the film's corners inside despite rounding.
    constexpr double kRounding = 1e-6;
    if (!(column > -kRounding && column < kColumns + kRounding && row > -kRounding && row < kRows + kRounding))
        return std::nullopt;
    const Grid::Values ray = rays_->at(column, row).value;
    if (!std::isfinite(ray[kLight])) return std::nullopt;
    const Vec3d direction = normalized(Vec3d{ray[0], ray[1], ray[2]}), foot = {ray[3], ray[4], ray[5]};
    Vec3d origin = reference_ + foot + ray[kStart] * direction;
    origin.z -= film_z_;
    return FilmProjection{origin, direction, ray[kLight]};
}

std::optional<Vec2<double>> ProjectionGrid::project(Vec3d point) const {
    const Vec3d from = point + Vec3d{0, 0, film_z_} - reference_;
    std::optional<GridPosition> at = nearest_node(from);
    if (!at || !find_position(from, *at)) return std::nullopt;
    const Vec2<double> size = cell_size();
    return Vec2<double>{-(area_.least.x + at->column * size.x), -(area_.least.y + at->row * size.y)};
}

std::optional<ProjectionGrid::GridPosition> ProjectionGrid::nearest_node(Vec3d from) const {
    constexpr int kNodeStride = 2;
    std::optional<GridPosition> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (int row = 0; row <= kRows; row += kNodeStride)
        for (int column = 0; column <= kColumns; column += kNodeStride) {
            const Grid::Values& ray = rays_->node(column, row);
            const Vec3d direction = {ray[0], ray[1], ray[2]}, to = from - Vec3d{ray[3], ray[4], ray[5]};
            const double along = dot(to, direction), sine_squared = 1 - along * along / dot(to, to);
            if (!(along > ray[kStart] && sine_squared < least)) continue;
            least = sine_squared;
            nearest = {static_cast<double>(column), static_cast<double>(row)};
        }
    return nearest;
}

bool ProjectionGrid::find_position(Vec3d from, GridPosition& at) const {
    constexpr int kMaxSteps = 30, kMaxHalvings = 8;
    constexpr double kClose = 1e-11, kMaxStep = 4;  // in cells of the grid
    Grid::Point ray = rays_->at(at.column, at.row);
    for (int i = 0; i < kMaxSteps; ++i) {
        // Newton's method on foot(column, row) + t direction(column, row) = from, which is linear in t.
        const auto vector_at = [](const Grid::Values& v, int k) { return Vec3d{v[k], v[k + 1], v[k + 2]}; };
        const Vec3d direction = vector_at(ray.value, 0), to = from - vector_at(ray.value, 3);
        const double t = dot(to, direction) / dot(direction, direction);
        const Vec3d by_column = vector_at(ray.by_column, 3) + t * vector_at(ray.by_column, 0);
        const Vec3d by_row = vector_at(ray.by_row, 3) + t * vector_at(ray.by_row, 0);
        const double volume = dot(cross(by_column, by_row), direction);
        double column = dot(cross(to, by_row), direction) / volume, row = dot(cross(by_column, to), direction) / volume;
        const double size = std::max(std::fabs(column), std::fabs(row));
        if (size > kMaxStep) column *= kMaxStep / size, row *= kMaxStep / size;
        GridPosition next = at;
        for (int halving = 0; halving <= kMaxHalvings; ++halving, column *= 0.5, row *= 0.5) {
            next = {std::clamp(at.column + column, 0.0, static_cast<double>(kColumns)),
                    std::clamp(at.row + row, 0.0, static_cast<double>(kRows))};
            ray = rays_->at(next.column, next.row);
            if (std::isfinite(ray.value[kLight])) break;
        }
        if (!std::isfinite(ray.value[kLight])) return false;
        const bool stays = std::max(std::fabs(next.column - at.column), std::fabs(next.row - at.row)) < kClose;
        at = next;
        // A step that is clamped at the border of the grid converges where no ray passes through the point.
        if (stays) return size < 10 * kClose && t > ray.value[kStart];
    }
    return false;
}

}  // namespace realcam
