#pragma once
#include <cstddef>
#include <vector>

#include "../trace/ray_loop.hpp"
#include "adjoint_trace.hpp"
#include "dual_path.hpp"

namespace REALCAM_NAMESPACE {

/// Rays, and the derivatives of a scalar function by their exit origins, unit directions and optical paths, as the
/// core's trace returns these. Arrays have three numbers for each ray, except one for its path.
struct AdjointRequest {
    std::size_t count;
    const double *origins, *directions;  ///< at the start, mm; directions of any length
    const double *of_origins, *of_directions, *of_paths;
    double *by_origins, *by_directions;  ///< results: derivatives by origins and directions
};

/// Reverse-mode differentiation of rays through a lens: the product of a vector with the Jacobian matrix, at a cost
/// that hardly depends on the number of variables. DualPath computes whole Jacobian matrices.
///
/// Rays are traced again, in lanes, and recorded at each surface. From the last surface backwards, the adjoints of the
/// ray behind a surface yield those of the ray before it and of the surface's own numbers (adjoint_trace.hpp). The dual
/// surfaces hold the derivatives of these numbers by the variables, which are applied once for all rays.
class AdjointPath {
public:
    /// For rays in the lens frame, which rims can block. Throws InputError for invalid variables (check_variables).
    AdjointPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                std::vector<LensVariable> variables);

    /// Returns the derivatives by the variables. Rays that do not pass count as constants: their derivatives are 0.
    /// Throws Cancelled.
    std::vector<double> gradient(const AdjointRequest& request, const RayLoop& loop = {}) const;

private:
    static constexpr int kLanes = 32;
    /// Sums over rays.
    struct Sums {
        std::vector<AdjointStep<kLanes>> steps;  ///< the first is that of the entering rays, then one per surface
        std::vector<std::vector<Dual8>> forms;  ///< for freeforms: adjoints in the lanes of their dual surfaces
        std::vector<AdjointSurface> surfaces;
        double entry_position = 0, entry_index = 0;
        Vec3d exit[4] = {};  ///< adjoints of the exit frame's origin and axes
    };

    void add_rays(const AdjointRequest& request, std::size_t first, std::size_t last, Sums& sums) const;
    void add_block(const AdjointRequest& request, std::size_t first, int used, Sums& sums) const;
    void add_variables(const Sums& sums, double* by) const;

    DualPath path_;
};

}  // namespace REALCAM_NAMESPACE
