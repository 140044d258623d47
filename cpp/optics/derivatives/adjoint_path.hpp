#pragma once
#include <cstddef>
#include <vector>

#include "../trace/ray_loop.hpp"
#include "adjoint_trace.hpp"
#include "dual_path.hpp"

namespace REALCAM_NAMESPACE {

/// Rays, and the derivatives of a function of where they leave: of their origins, unit directions and optical paths as
/// the core's trace returns them. Three numbers for each ray, but one for its path.
struct AdjointRequest {
    std::size_t count;
    const double *origins, *directions;  ///< at the start, mm; directions of any length
    const double *of_origins, *of_directions, *of_paths;
    double *by_origins, *by_directions;  ///< results: derivatives by the given origins and directions
};

/// Reverse-mode differentiation of rays through a lens: the product of a vector with the Jacobian matrix, at a cost
/// that hardly depends on the number of variables. Whole matrices are DualPath's.
///
/// Rays are traced once more, in lanes, and kept at each surface. From the last surface back, their adjoints become
/// those before it and those of its own numbers (adjoint_trace.hpp). How these numbers depend on the variables is
/// what the dual surfaces know, and is needed once for all rays.
class AdjointPath {
public:
    /// Of rays in the lens frame, with rims. Throws InputError for variables that make no sense.
    AdjointPath(const LensSystem& lens, LightDirection direction, double wavelength_nm,
                std::vector<LensVariable> variables);

    /// The derivatives by the variables. Rays that do not pass count as constants, and have zeros. Throws Cancelled.
    std::vector<double> gradient(const AdjointRequest& request, const RayLoop& loop = {}) const;

private:
    static constexpr int kLanes = 32;
    /// What is added up over rays.
    struct Sums {
        std::vector<AdjointStep<kLanes>> steps;  ///< the first is of the rays that enter
        std::vector<std::vector<Dual8>> forms;  ///< of freeforms, in the lanes of their duals
        std::vector<AdjointSurface> surfaces;
        double entry_position = 0, entry_index = 0;
        Vec3d exit[4] = {};  ///< the adjoints of the exit frame's origin and axes
    };

    void add_rays(const AdjointRequest& request, std::size_t first, std::size_t last, Sums& sums) const;
    void add_block(const AdjointRequest& request, std::size_t first, int used, Sums& sums) const;
    void add_variables(const Sums& sums, double* by) const;

    DualPath path_;
};

}  // namespace REALCAM_NAMESPACE
