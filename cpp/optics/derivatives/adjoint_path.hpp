#pragma once
#include <cstddef>
#include <vector>

#include "../trace/ray_loop.hpp"
#include "adjoint_trace.hpp"
#include "dual_path.hpp"

namespace REALCAM_NAMESPACE {

/// Rays, and the derivatives of a scalar function by the results of their trace: origins, unit directions and optical
/// paths behind the lens. Arrays have three numbers per ray; `of_paths` has one.
struct AdjointRequest {
    std::size_t count;
    const double *origins, *directions;  ///< rays at the start: mm, lens frame; directions of any length
    const double *of_origins, *of_directions, *of_paths;  ///< derivatives of the function by the results of the trace
    double *by_origins, *by_directions;  ///< results: derivatives of the function by `origins` and `directions`
};

/// Reverse-mode differentiation of rays through a lens: computes the product of a vector with the Jacobian matrix, at a
/// cost that hardly depends on the number of variables. DualPath computes whole Jacobian matrices.
///
/// Rays are traced in lanes and recorded behind each surface. From the last surface backwards, the adjoints of a ray
/// behind a surface yield those of the ray in front of it and of the surface's own numbers (adjoint_trace.hpp). The
/// derivatives of these numbers by the variables, from dual surfaces, are applied once for all rays.
class AdjointPath {
public:
    /// Prepares the lens for rays in the lens frame; rims block rays. Throws InputError if a variable is invalid
    /// (check_variables).
    AdjointPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                std::vector<LensVariable> variables);

    /// Returns the derivatives of the function by the variables, and sets those by origins and directions. Rays that do
    /// not pass the lens do not contribute: their derivatives are 0. Throws Cancelled if `loop` is cancelled.
    std::vector<double> gradient(const AdjointRequest& request, const RayLoop& loop = {}) const;

private:
    static constexpr int kLanes = 32;  ///< rays that are traced together
    /// Sums of adjoints over rays, and working memory.
    struct Sums {
        std::vector<AdjointStep<kLanes>> steps;  ///< the entering rays, then one step per surface
        std::vector<std::vector<Dual8>> forms;  ///< for freeforms: adjoints in the lanes of their dual surfaces
        std::vector<AdjointSurface> surfaces;
        double entry_position = 0, entry_index = 0;  ///< adjoints of the position and index at which rays enter
        Vec3d exit[4] = {};  ///< adjoints of the exit frame's origin and axes
    };

    /// Adds the adjoints of rays `first` to `last` - 1.
    void add_rays(const AdjointRequest& request, std::size_t first, std::size_t last, Sums& sums) const;
    /// Adds the adjoints of `used` rays from `first` on, which fill at most kLanes lanes.
    void add_block(const AdjointRequest& request, std::size_t first, int used, Sums& sums) const;
    /// Adds the derivatives by the variables, which follow from the adjoints of the lens's numbers, to `by`.
    void add_variables(const Sums& sums, double* by) const;

    DualPath path_;
};

}  // namespace REALCAM_NAMESPACE
