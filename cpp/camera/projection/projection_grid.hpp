#pragma once
#include <vector>

#include "../../math/smooth_grid.hpp"
#include "../../optics/analysis/scene_bundle.hpp"
#include "../../optics/pupil/pupil_grid.hpp"
#include "../../optics/trace/ray_loop.hpp"
#include "projection.hpp"

namespace REALCAM_NAMESPACE {

/// Projection rays of a lens without rotational symmetry: computed at the nodes of a grid over the film, with smooth
/// interpolation in between. Cells of the grid with a corner that receives no light have no rays.
class ProjectionGrid : public ProjectionRays {
public:
    /// `setup`: set-up of the camera, with a PupilGrid. Covers the camera's film and a margin. Throws InputError.
    ProjectionGrid(const CameraSetup& setup, ProjectionRay ray, const RayLoop& loop = {});

    bool ends_in_film() const override { return ends_in_film_; }
    bool is_in_front(Vec3d point) const override { return point.z + film_z_ < reference_.z; }
    std::optional<FilmProjection> ray(Vec2<double> film) const override;
    std::optional<Vec2<double>> project(Vec3d point) const override;

private:
    /// Number of grid cells. If the lens has a plane of symmetry, only one half of the grid is traced.
    static constexpr int kColumns = 24, kRows = 16;

    /// Projection ray of a film point: its unit direction; `foot`, its point nearest to the reference point, relative
    /// to the latter; `start`, the position along the ray, from the foot, where it leaves the lens; the film point's
    /// irradiance; and, as `shift`, the offset on the film of the light's centroid for the ray's point in focus, mm.
    struct NodeRay {
        Vec3d direction, foot;
        double start, light;
        Vec2<double> shift;
    };
    /// Number of values of a ray in the grid: direction, foot, start and light; and the indices of the last two.
    static constexpr int kRayValues = 8, kStart = 6, kLight = 7;
    using Grid = SmoothGrid<kRayValues>;
    using ShiftedGrid = SmoothGrid<kRayValues + 2>;  ///< with the two coordinates of `shift` appended

    NodeRay node_ray(const SceneRay& ray, double light, Vec2<double> shift) const;

    /// Column and row of a node index.
    static int column_of(int node) { return node % (kColumns + 1); }
    static int row_of(int node) { return node / (kColumns + 1); }
    Vec2<double> cell_size() const;  ///< mm
    /// Film point of a node in the lens's axes, mm.
    Vec2<double> film_point(int column, int row) const;

    /// Values at all nodes of the rays that ray_at(film point) returns as std::optional<NodeRay>; NaN for std::nullopt.
    /// It is only called for nodes from which the others follow by symmetry.
    template <class RayAt>
    std::vector<ShiftedGrid::Values> node_values(RayAt&& ray_at, const RayLoop& loop) const;

    /// Assigns each node the ray for whose point in focus the light's centroid lies at the node.
    std::vector<Grid::Values> rays_by_light_centroid(const ShiftedGrid& traced) const;

    /// Stores the rays, with their light relative to that at the film centre.
    void store(std::vector<Grid::Values> rays);

    /// Position in the grid, in columns and rows.
    struct GridPosition {
        double column, row;
    };
    /// Node whose ray passes nearest to a point, by angle. Returns std::nullopt if the point lies in front of no ray's
    /// start. `from`: point relative to the reference point.
    std::optional<GridPosition> nearest_node(Vec3d from) const;
    /// Moves `at`, by Newton's method, to the position in the grid whose ray passes through a point. Returns false if
    /// no ray does.
    bool find_position(Vec3d from, GridPosition& at) const;

    FilmArea area_;  ///< area of the grid, in the lens's axes, mm
    MirrorPlanes planes_;
    Vec3d reference_;  ///< centre of the entrance pupil or, if that is far away, where the chief ray leaves the lens;
                       ///< in the camera's frame (film_path_ends), mm
    double film_z_;  ///< z of the film in that frame
    bool ends_in_film_ = false;
    std::optional<Grid> rays_;
};

}  // namespace REALCAM_NAMESPACE
