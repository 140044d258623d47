#pragma once
#include <vector>

#include "../math/smooth_grid.hpp"
#include "../optics/analysis/scene_bundle.hpp"
#include "../optics/pupil/pupil_grid.hpp"
#include "../optics/trace/ray_loop.hpp"
#include "lines_of_sight.hpp"

namespace REALCAM_NAMESPACE {

/// The lines of sight of a film whose lens is not of revolution: known at the nodes of a grid over the film, and smooth
/// between them. Cells of the grid with a corner that gets no light have none.
class SightGrid : public LinesOfSight {
public:
    /// `setup`: of the camera, with the pupil in two dimensions. The lines are those of its film and a margin. Throws
    /// InputError.
    SightGrid(const CameraSetup& setup, SightRay ray, const RayLoop& loop = {});

    bool ends_in_film() const override { return ends_in_film_; }
    bool is_in_front(Vec3d point) const override { return point.z + film_z_ < reference_.z; }
    std::optional<FilmSight> from(Vec2<double> place) const override;
    std::optional<Vec2<double>> place_of(Vec3d point) const override;

private:
    /// Of cells. One that is its own mirror image in a plane is looked at in one half.
    static constexpr int kColumns = 24, kRows = 16;

    /// A film point's line: its unit direction, and its point nearest to the reference point, relative to that. Where
    /// it leaves the lens, along it from there, and the film point's light. Then by how much the middle of the light of
    /// its point in focus lies elsewhere on the film, mm.
    struct Seen {
        Vec3d direction, foot;
        double start, light;
        Vec2<double> shift;
    };
    static constexpr int kNumbers = 8, kLight = 7;  ///< of a line, and which of them is its light
    using Grid = SmoothGrid<kNumbers>;
    using SeenGrid = SmoothGrid<kNumbers + 2>;

    Seen seen_along(const SceneRay& ray, double light, Vec2<double> shift) const;

    static int column_of(int node) { return node % (kColumns + 1); }
    static int row_of(int node) { return node / (kColumns + 1); }
    Vec2<double> cell_size() const;
    Vec2<double> film_point(int column, int row) const;

    /// look(film point) for all nodes, or for those from which the others follow by symmetry.
    template <class Look>
    std::vector<SeenGrid::Values> nodes_by(Look&& look, const RayLoop& loop) const;

    /// Gives each node the line whose point in focus has the middle of its light there.
    std::vector<Grid::Values> shown_where_light_lands(const SeenGrid& seen) const;

    /// The light of all relative to that in the middle of the film.
    void finish(std::vector<Grid::Values> lines);

    /// Columns and rows of the grid.
    struct GridPlace {
        double column, row;
    };
    /// Whose line passes nearest to a point, by the angle. Points are relative to the reference point.
    std::optional<GridPlace> nearest_node(Vec3d from) const;
    /// From there to the place whose line goes through the point. False where there is none.
    bool follow(Vec3d from, GridPlace& at) const;

    FilmArea area_;
    MirrorPlanes planes_;
    Vec3d reference_;  ///< the middle of the entrance pupil, in the frame of the camera (film_path_ends), mm
    double film_z_;  ///< of the film there
    bool ends_in_film_ = false;
    std::optional<Grid> lines_;
};

}  // namespace REALCAM_NAMESPACE
